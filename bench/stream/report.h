// What a scenario of the stream benches has to say: a table for people, a verdict per figure, JSON lines for programs.
#pragma once
#include <string>
#include <vector>

namespace caustream::bench {

struct Figure {
    std::string scenario, name, unit;
    double value = 0;
    std::string limit;    // in words, "<= 125"; empty: shown, not judged
    bool held = true;
};

class Report {
   public:
    explicit Report(std::string scenario) : scenario_(std::move(scenario)) {}

    void atMost(const std::string& name, double value, double most, const std::string& unit);
    void atLeast(const std::string& name, double value, double least, const std::string& unit);
    void shown(const std::string& name, double value, const std::string& unit);
    // A sentence of the table's heading: how it was measured.
    void note(const std::string& text);

    void print() const;                              // notes, then a line per figure: PASS, MISS or neither
    std::string json() const;                        // a line per figure
    std::string markdown() const;                    // rows of a table
    bool held() const;
    const std::vector<Figure>& figures() const { return figures_; }

   private:
    std::string scenario_;
    std::vector<std::string> notes_;
    std::vector<Figure> figures_;
};

}  // namespace caustream::bench
