// Results as they come, one JSON object a line, so that a run that was cut short goes on where it ended.
#pragma once
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace caustream::bench {

class Journal {
   public:
    // Reads what `path` holds; a last line cut short, or a damaged one, is dropped. `fresh` empties it first.
    // Throws Error when it cannot be written.
    explicit Journal(const std::string& path, bool fresh = false);

    // The results under `key`, in the order they came. A key names everything that a result depends on.
    const std::vector<nlohmann::json>& of(const nlohmann::json& key) const;
    // On disk when this returns.
    void add(const nlohmann::json& key, const nlohmann::json& result);

   private:
    std::map<std::string, std::vector<nlohmann::json>> results_;   // by the key's text
    std::ofstream file_;
    std::string path_;
};

}  // namespace caustream::bench
