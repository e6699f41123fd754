// Outcomes as text, Markdown, CSV and JSON.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/accuracy/study.h"

namespace caustream::bench {

// A scene's outcomes and what goes with all of them.
struct Results {
    std::string scene, where;        // where: "on 256 x 256 cells of the floor"
    double luminanceNoise = 0, bandsNoise = 0;
    std::vector<Outcome> outcomes;
};

// Rows of equally many cells, the first the heads, as a Markdown table whose columns line up: for terminals, too.
std::string table(const std::vector<std::vector<std::string>>& rows);

// Every outcome, fastest first; members of the Pareto front are starred. Of the front alone if `frontOnly`.
std::string outcomeTable(const Results& results, bool frontOnly);
// "prism: best at 16 ms: ...; at 50 ms: ...; unlimited: ..."
std::string bestLine(const Results& results);
std::string csv(const std::vector<Results>& all);
nlohmann::json json(const std::vector<Results>& all);

// "- met: sphere: ..." or "- NOT met: ...", a line.
std::string claim(bool met, const std::string& what);

// printf to a string.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);
// Throws Error when it cannot be written.
void writeFile(const std::string& path, const std::string& text);

}  // namespace caustream::bench
