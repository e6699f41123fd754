#include "bench/accuracy/tables.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "error.h"

namespace caustream::bench {

namespace {

std::vector<Cost> costsOf(const Results& results) {
    std::vector<Cost> costs;
    for (const Outcome& outcome : results.outcomes) costs.push_back(outcome.cost());
    return costs;
}

double farthest(const std::vector<double>& values, double from) {
    double worst = from;
    for (const double value : values) worst = std::abs(value - from) > std::abs(worst - from) ? value : worst;
    return worst;
}

}  // namespace

std::string format(const char* pattern, ...) {
    char text[512];
    std::va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(text, sizeof text, pattern, arguments);
    va_end(arguments);
    return text;
}

std::string claim(bool met, const std::string& what) { return format("- %s: %s\n", met ? "met" : "NOT met", what.c_str()); }

std::string table(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths(rows.front().size());
    for (const auto& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string text;
    const auto add = [&](const std::vector<std::string>& row) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string space(widths[i] - row[i].size(), ' ');
            text += i == 0 ? "| " + row[i] + space : " | " + space + row[i];
        }
        text += " |\n";
    };
    add(rows.front());
    for (std::size_t i = 0; i < widths.size(); ++i) text += i == 0 ? "| " + std::string(widths[i], '-') : " | " + std::string(widths[i] - 1, '-') + ":";
    text += " |\n";
    for (std::size_t i = 1; i < rows.size(); ++i) add(rows[i]);
    return text;
}

std::string outcomeTable(const Results& results, bool frontOnly) {
    const std::vector<Cost> costs = costsOf(results);
    const std::vector<std::size_t> front = paretoFront(costs);
    std::vector<std::size_t> order(costs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return costs[a].ms < costs[b].ms; });
    std::vector<std::vector<std::string>> rows = {{"configuration", "ms", "+-", "light ms", "photons", "L1 of Y", "of XYZ", "of 7 bands", "flux Y",
                                                   "worst cell", "centroid %", "dE mean", "dE 99%"}};
    for (const std::size_t i : order) {
        const bool member = std::ranges::find(front, i) != front.end();
        if (frontOnly && !member) continue;
        const Outcome& o = results.outcomes[i];
        const MapError& e = o.error;
        rows.push_back({o.configuration.name() + (member && !frontOnly ? " *" : ""), format("%.1f", o.ms), format("%.1f", o.spreadMs),
                        format("%.1f", o.lightMs), format("%u", e.photons), format("%.4f", e.luminance), format("%.4f", e.colour),
                        format("%.4f", e.bands), format("%.3f", e.fluxRatio), format("%.1f", e.worst), format("%.2f", 100.0 * farthest(e.bandCentroid, 0.0)),
                        format("%.2f", e.picture), format("%.1f", e.pictureP99)});
    }
    return table(rows);
}

std::string bestLine(const Results& results) {
    const std::vector<Cost> costs = costsOf(results);
    const auto name = [&](std::optional<std::size_t> i) {
        if (!i) return std::string("none is that fast");
        const Outcome& o = results.outcomes[*i];
        return format("%s (%.1f ms, L1 %.4f)", o.configuration.name().c_str(), o.ms, o.error.luminance);
    };
    return results.scene + ": best at 16 ms: " + name(bestWithin(costs, 16.0)) + "; at 50 ms: " + name(bestWithin(costs, 50.0)) +
           "; unlimited: " + name(bestWithin(costs));
}

nlohmann::json json(const std::vector<Results>& all) {
    nlohmann::json scenes = nlohmann::json::array();
    for (const Results& results : all) {
        const std::vector<std::size_t> front = paretoFront(costsOf(results));
        nlohmann::json outcomes = nlohmann::json::array();
        for (std::size_t i = 0; i < results.outcomes.size(); ++i) {
            const Outcome& o = results.outcomes[i];
            nlohmann::json entry = o.error;
            entry["configuration"] = o.configuration.name();
            entry["ms"] = o.ms, entry["light_ms"] = o.lightMs, entry["spread_ms"] = o.spreadMs;
            entry["on_front"] = std::ranges::find(front, i) != front.end();
            outcomes.push_back(std::move(entry));
        }
        scenes.push_back({{"scene", results.scene}, {"compared", results.where}, {"reference_error_luminance", results.luminanceNoise},
                          {"reference_error_bands", results.bandsNoise}, {"bands_nm", bandsNm()}, {"outcomes", std::move(outcomes)}});
    }
    return scenes;
}

std::string csv(const std::vector<Results>& all) {
    std::string text = "scene,configuration,ms,spread_ms,light_ms,photons,l1_luminance,l1_xyz,l1_bands,flux_ratio,worst_cell,ciede2000,ciede2000_p99,"
                       "estimate,on_front";
    for (const char* what : {"flux", "centroid"}) {
        for (const double nm : bandsNm()) text += format(",%s_%.0f", what, nm);
    }
    text += "\n";
    for (const Results& results : all) {
        const std::vector<std::size_t> front = paretoFront(costsOf(results));
        for (std::size_t i = 0; i < results.outcomes.size(); ++i) {
            const Outcome& o = results.outcomes[i];
            const MapError& e = o.error;
            text += format("%s,%s,%.3f,%.3f,%.3f,%u,%.6f,%.6f,%.6f,%.6f,%.4f,%.4f,%.4f,", results.scene.c_str(), o.configuration.name().c_str(), o.ms,
                           o.spreadMs, o.lightMs, e.photons, e.luminance, e.colour, e.bands, e.fluxRatio, e.worst, e.picture, e.pictureP99);
            text += (e.estimate >= 0.0 ? format("%.6f", e.estimate) : "") + (std::ranges::find(front, i) != front.end() ? ",1" : ",0");
            for (const double value : e.bandFluxRatio) text += format(",%.6f", value);
            for (const double value : e.bandCentroid) text += format(",%.6f", value);
            text += "\n";
        }
    }
    return text;
}

void writeFile(const std::string& path, const std::string& text) {
    if (const auto folder = std::filesystem::path(path).parent_path(); !folder.empty()) {
        std::error_code ignored;   // opening says it
        std::filesystem::create_directories(folder, ignored);
    }
    std::ofstream file(path, std::ios::binary);
    file << text;
    if (!file.flush()) throw Error("cannot write " + path + "; name another folder with --out");
}

}  // namespace caustream::bench
