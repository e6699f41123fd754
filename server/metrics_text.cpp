#include "metrics_text.h"

#include <prometheus/text_serializer.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace caustream {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricType;

ClientMetric metricOf(const MetricsText::Labelled& labelled, MetricType type) {
    ClientMetric metric;
    for (const auto& [name, value] : labelled.labels) {
        metric.label.push_back({name, value});
    }
    (type == MetricType::Counter ? metric.counter.value : metric.gauge.value) = labelled.value;
    return metric;
}

// proc(5): the fields of /proc/self/stat after the program's name, which may hold blanks.
std::vector<double> statFields() {
    std::ifstream file("/proc/self/stat");
    std::string line;
    std::getline(file, line);
    std::istringstream rest(line.substr(line.rfind(')') + 1));
    std::string state;
    rest >> state;
    std::vector<double> fields;
    for (double value = 0.0; rest >> value;) {
        fields.push_back(value);
    }
    return fields;
}

double bootTimeS() {
    std::ifstream file("/proc/stat");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("btime ")) {
            return std::stod(line.substr(6));
        }
    }
    return 0.0;
}

}  // namespace

prometheus::MetricFamily& MetricsText::add(std::string_view name, std::string_view help, MetricType type) {
    const std::string prefix = name.starts_with("process_") ? "" : "caustream_";
    return families_.emplace_back(prometheus::MetricFamily{prefix + std::string(name), std::string(help), type, {}});
}

void MetricsText::gauge(std::string_view name, std::string_view help, double value) { gauges(name, help, {{{}, value}}); }
void MetricsText::counter(std::string_view name, std::string_view help, double value) { counters(name, help, {{{}, value}}); }

void MetricsText::gauges(std::string_view name, std::string_view help, const std::vector<Labelled>& values) {
    prometheus::MetricFamily& family = add(name, help, MetricType::Gauge);
    for (const Labelled& value : values) {
        family.metric.push_back(metricOf(value, MetricType::Gauge));
    }
}

void MetricsText::counters(std::string_view name, std::string_view help, const std::vector<Labelled>& values) {
    prometheus::MetricFamily& family = add(name, help, MetricType::Counter);
    for (const Labelled& value : values) {
        family.metric.push_back(metricOf(value, MetricType::Counter));
    }
}

void MetricsText::histogram(std::string_view name, std::string_view help, const prometheus::Histogram& values) {
    add(name, help, MetricType::Histogram).metric.push_back(values.Collect());
}

std::string MetricsText::text() const { return prometheus::TextSerializer().Serialize(families_); }

void addProcessMetrics(MetricsText& text) {
    const double ticks = static_cast<double>(sysconf(_SC_CLK_TCK));
    if (const std::vector<double> fields = statFields(); fields.size() > 20) {  // the third field of proc(5) is fields[-1]
        text.counter("process_cpu_seconds_total", "Processor time, user's and system's.", (fields[10] + fields[11]) / ticks);
        text.gauge("process_threads", "Threads.", fields[16]);
        text.gauge("process_start_time_seconds", "When the process started, since 1970.", bootTimeS() + fields[18] / ticks);
        text.gauge("process_virtual_memory_bytes", "Address space.", fields[19]);
        text.gauge("process_resident_memory_bytes", "Memory that is resident.", fields[20] * static_cast<double>(sysconf(_SC_PAGESIZE)));
    }
    std::error_code problem;
    double open = 0.0;
    for (std::filesystem::directory_iterator at("/proc/self/fd", problem), end; !problem && at != end; at.increment(problem)) {
        ++open;
    }
    text.gauge("process_open_fds", "Open file descriptors.", open - 1);  // without the one that lists them
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) == 0) {
        text.gauge("process_max_fds", "As many as may be open.", static_cast<double>(limit.rlim_cur));
    }
}

}  // namespace caustream
