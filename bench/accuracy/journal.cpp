#include "bench/accuracy/journal.h"

#include <filesystem>

#include "error.h"

namespace caustream::bench {

using nlohmann::json;

Journal::Journal(const std::string& path, bool fresh) : path_(path) {
    bool cutShort = false;
    if (!fresh) {
        std::ifstream old(path);
        for (std::string line; std::getline(old, line);) {
            cutShort = old.eof();   // the last line lacks its end
            const json entry = json::parse(line, nullptr, false);
            if (entry.is_object() && entry.contains("key") && entry.contains("result")) {
                results_[entry["key"].dump()].push_back(entry["result"]);
            }
        }
    }
    if (const auto folder = std::filesystem::path(path).parent_path(); !folder.empty()) {
        std::error_code ignored;   // opening says it
        std::filesystem::create_directories(folder, ignored);
    }
    file_.open(path, fresh ? std::ios::trunc : std::ios::app);
    if (cutShort) file_ << "\n";
    if (!file_) throw Error("cannot write " + path + "; name another folder");
}

const std::vector<json>& Journal::of(const json& key) const {
    static const std::vector<json> none;
    const auto found = results_.find(key.dump());
    return found == results_.end() ? none : found->second;
}

void Journal::add(const json& key, const json& result) {
    file_ << json{{"key", key}, {"result", result}}.dump() << std::endl;
    if (!file_) throw Error("cannot write " + path_ + "; is the disk full?");
    results_[key.dump()].push_back(result);
}

}  // namespace caustream::bench
