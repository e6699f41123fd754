// The files that were sent, for another server that lacks what is shown.
#pragma once
#include <cstddef>
#include <deque>
#include <string>
#include <utility>

#include "client/connection/upload.h"

namespace caustream::connection {

class KeptFiles {
 public:
    // Forgets the oldest ones beyond `mostBytes` together; the newest always stays.
    void put(const std::string& sha256, Bytes bytes, std::size_t mostBytes) {
        std::erase_if(files_, [&](const auto& file) { return file.first == sha256; });
        files_.emplace_back(sha256, std::move(bytes));
        std::size_t total = 0;
        for (const auto& file : files_) total += file.second->size();
        while (files_.size() > 1 && total > mostBytes) {
            total -= files_.front().second->size();
            files_.pop_front();
        }
    }
    // Nothing if it was not sent, or forgotten.
    Bytes get(const std::string& sha256) const {
        for (const auto& file : files_)
            if (file.first == sha256) return file.second;
        return nullptr;
    }

 private:
    std::deque<std::pair<std::string, Bytes>> files_;  // by their SHA-256, oldest first
};

}  // namespace caustream::connection
