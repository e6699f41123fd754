// Metrics in Prometheus' text format (0.0.4), one after the other. Names get the prefix "caustream_" except "process_...".
#pragma once
#include <prometheus/histogram.h>
#include <prometheus/metric_family.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace caustream {

class MetricsText {
   public:
    using Label = std::pair<std::string, std::string>;
    // One value of a metric with labels.
    struct Labelled {
        std::vector<Label> labels;
        double value = 0.0;
    };

    void gauge(std::string_view name, std::string_view help, double value);
    void gauges(std::string_view name, std::string_view help, const std::vector<Labelled>& values);
    void counter(std::string_view name, std::string_view help, double value);
    void counters(std::string_view name, std::string_view help, const std::vector<Labelled>& values);
    void histogram(std::string_view name, std::string_view help, const prometheus::Histogram& values);

    std::string text() const;

   private:
    prometheus::MetricFamily& add(std::string_view name, std::string_view help, prometheus::MetricType type);

    std::vector<prometheus::MetricFamily> families_;
};

// Memory, descriptors, processor time and start of this process, by the names that all programs use.
void addProcessMetrics(MetricsText& text);

}  // namespace caustream
