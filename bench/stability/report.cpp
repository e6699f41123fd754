#include "bench/stability/report.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/statistics.h"

namespace caustream::stability {

namespace {

// What a line of the table sums up.
struct Row {
    std::string group, mode;
    int cases = 0, failed = 0;
    double worstGap = 0.0, worstChange = 0.0;
    std::vector<double> changes, ms;
};

std::string format(const char* pattern, auto... values) {
    char text[512];
    std::snprintf(text, sizeof text, pattern, values...);
    return text;
}

void add(Row& row, const Outcome& outcome) {
    ++row.cases;
    row.failed += !outcome.failures.empty();
    row.worstGap = std::max(row.worstGap, outcome.ledgerGap);
    if (outcome.jumps.empty()) row.worstChange = std::max(row.worstChange, outcome.change);
    row.changes.push_back(outcome.change);
    row.ms.push_back(outcome.ms);
}

// By group within mode, in the order of the results; each mode ends with its sum.
std::vector<Row> rowsOf(const std::vector<Result>& results) {
    std::vector<std::string> modes, groups;
    for (const Result& result : results) {
        if (std::find(modes.begin(), modes.end(), result.mode) == modes.end()) modes.push_back(result.mode);
        if (std::find(groups.begin(), groups.end(), result.group) == groups.end()) groups.push_back(result.group);
    }
    std::vector<Row> rows;
    for (const std::string& mode : modes) {
        Row all{.group = "all", .mode = mode, .changes = {}, .ms = {}};
        for (const std::string& group : groups) {
            Row row{.group = group, .mode = mode, .changes = {}, .ms = {}};
            for (const Result& result : results) {
                if (result.mode == mode && result.group == group) add(row, result.outcome), add(all, result.outcome);
            }
            if (row.cases > 0) rows.push_back(std::move(row));
        }
        rows.push_back(std::move(all));
    }
    return rows;
}

// Shares of all searches of one kind, by how near they ended: per cent.
struct Share {
    const char* name;
    render::Residuals::Histogram render::Residuals::*counts;
};
constexpr Share kShares[] = {{"exit point, searched", &render::Residuals::exit},
                             {"exit point, one step from a neighbour's", &render::Residuals::exitFollowed},
                             {"receiver", &render::Residuals::receiver}};
constexpr const char* kBins[] = {"< 1e-6", "1e-5", "1e-4", "1e-3", "1e-2", "0.1", "1", "10", "more"};

std::vector<double> sharesOf(const std::vector<Result>& results, const std::string& mode, const Share& share) {
    std::vector<double> sums(std::size(kBins), 0.0);
    double total = 0.0;
    for (const Result& result : results) {
        if (result.mode != mode || !result.outcome.residuals) continue;
        const auto& counts = (*result.outcome.residuals).*share.counts;
        for (std::size_t i = 0; i < counts.size(); ++i) sums[i] += counts[i], total += counts[i];
    }
    for (double& sum : sums) sum *= total > 0.0 ? 100.0 / total : 0.0;
    return total > 0.0 ? sums : std::vector<double>{};
}

std::set<std::string> modesOf(const std::vector<Result>& results) {
    std::set<std::string> modes;
    for (const Result& result : results) modes.insert(result.mode);
    return modes;
}

std::string failureLines(const std::vector<Result>& results, const char* pattern, bool onlyThoseThatCount) {
    std::string text;
    for (const Result& result : results) {
        if (onlyThoseThatCount && !result.mustPass) continue;
        for (const Failure& failure : result.outcome.failures) {
            text += format(pattern, result.name.c_str(), result.mode.c_str(), failure.check.c_str(), failure.what.c_str());
        }
    }
    return text;
}

// A baseline fails often: the cases of one check in one line.
std::string listedFailures(const std::vector<Result>& results) {
    std::map<std::pair<std::string, std::string>, std::string> names;   // by mode and check
    for (const Result& result : results) {
        if (result.mustPass) continue;
        for (const Failure& failure : result.outcome.failures) names[{result.mode, failure.check}] += (names[{result.mode, failure.check}].empty() ? "" : ", ") + result.name;
    }
    std::string text;
    for (const auto& [key, cases] : names) text += "- " + key.first + ", " + key.second + ": " + cases + "\n";
    return text;
}

// Cases that are not held to the bound on small changes, each once.
std::string jumpLines(const std::vector<Result>& results) {
    std::map<std::string, std::string> reasons;
    for (const Result& result : results) {
        if (!result.outcome.jumps.empty()) reasons[result.name] = result.outcome.jumps;
    }
    std::string text;
    for (const auto& [name, reason] : reasons) text += "- `" + name + "`: " + reason + "\n";
    return reasons.empty() ? "" : "\nNot held to the bound on small changes:\n\n" + text;
}

std::string residualTable(const std::vector<Result>& results, const char* first, const char* cell, const char* end) {
    std::string text;
    for (const std::string& mode : modesOf(results)) {
        for (const Share& share : kShares) {
            const std::vector<double> shares = sharesOf(results, mode, share);
            if (shares.empty()) continue;
            text += format(first, mode.c_str(), share.name);
            for (const double percent : shares) text += format(cell, percent);
            text += end;
        }
    }
    return text;
}

// What became of the flux on casters.
nlohmann::json ledgerShares(const render::EnergyLedger& l) {
    const double all = l.onCasters > 0.0 ? l.onCasters : 1.0;
    return {{"deposited", l.deposited / all}, {"absorbed", l.absorbed / all}, {"reflected", l.reflected / all},
            {"total_reflection", l.totalReflection / all}, {"rejected", l.rejected / all}, {"left_map", l.leftMap / all},
            {"no_receiver", l.noReceiver / all}, {"cut", l.cut / all}};
}

}  // namespace

int failuresThatCount(const std::vector<Result>& results) {
    return static_cast<int>(std::count_if(results.begin(), results.end(), [](const Result& r) { return r.mustPass && !r.outcome.failures.empty(); }));
}

std::string textReport(const std::vector<Result>& results) {
    std::string text = format("%-11s %-11s %6s %7s %11s %13s %12s %9s\n", "mode", "group", "cases", "failed", "ledger gap", "median change", "worst change", "ms a case");
    for (const Row& row : rowsOf(results)) {
        text += format("%-11s %-11s %6d %7d %11.1e %13.1e %12.1e %9.0f\n", row.mode.c_str(), row.group.c_str(), row.cases, row.failed,
                       row.worstGap, bench::median(row.changes), row.worstChange, bench::median(row.ms));
    }
    const std::string failures = failureLines(results, "  --case %s --mode %s: %s: %s\n", false);
    text += failures.empty() ? "\nno failures\n" : "\nfailures\n" + failures;
    text += jumpLines(results);
    text += "\nper cent of searches that ended within so many tolerances\n" + format("%-52s", "");
    for (const char* bin : kBins) text += format("%8s", bin);
    return text + "\n" + residualTable(results, "%-11s %-40s", "%8.3f", "\n");
}

std::string markdownReport(const std::vector<Result>& results) {
    std::string text = "| mode | cases | number | failed | worst ledger gap | median change | worst change | ms a case |\n"
                       "| --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const Row& row : rowsOf(results)) {
        text += format("| %s | %s | %d | %d | %.1e | %.1e | %.1e | %.0f |\n", row.mode.c_str(), row.group.c_str(), row.cases, row.failed,
                       row.worstGap, bench::median(row.changes), row.worstChange, bench::median(row.ms));
    }
    const std::string failures = failureLines(results, "- `--case %s --mode %s`: %s: %s\n", true), listed = listedFailures(results);
    text += failures.empty() ? "\nNo failures where none may be.\n" : "\nFailures:\n\n" + failures;
    if (!listed.empty()) text += "\nFailures of the baseline, by check:\n\n" + listed;
    text += jumpLines(results);
    text += "\nPer cent of searches that ended within so many tolerances:\n\n| mode | search |";
    for (const char* bin : kBins) text += format(" %s |", bin);
    text += "\n| --- | --- |";
    for (std::size_t i = 0; i < std::size(kBins); ++i) text += " --- |";
    return text + "\n" + residualTable(results, "| %s | %s |", " %.3f |", "\n");
}

std::string jsonLine(const Result& result) {
    nlohmann::json line{{"case", result.name}, {"group", result.group}, {"mode", result.mode}, {"photons", result.outcome.photons},
                        {"ledger_gap", result.outcome.ledgerGap}, {"change", result.outcome.change}, {"ms", result.outcome.ms},
                        {"ledger", ledgerShares(result.outcome.ledger)}, {"warnings", result.outcome.warnings}, {"failures", nlohmann::json::array()}};
    for (const Failure& failure : result.outcome.failures) line["failures"].push_back({{"check", failure.check}, {"what", failure.what}});
    if (result.outcome.residuals) {
        for (const Share& share : kShares) line["residuals"][share.name] = (*result.outcome.residuals).*share.counts;
    }
    return line.dump();
}

}  // namespace caustream::stability
