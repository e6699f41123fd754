#include "client/shot/batch_plan.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "client/connection/upload.h"
#include "protocol/patch.h"

namespace caustream::shot {
namespace {

using protocol::Json;
using Wrong = tl::unexpected<LineError>;

constexpr int kKeyVersion = 1;  // of what a line's files are: another one draws them anew

std::string hashOf(std::span<const std::uint8_t> bytes) { return connection::sha256Hex(bytes); }

class Planner {
 public:
    explicit Planner(const PlanOptions& options) : options_(options) {}

    tl::expected<LineJob, LineError> job(const BatchLine& line, int number) {
        if (!names_.insert(line.name).second) return wrong("name", "another line is called " + line.name + ", too");
        LineJob job{.number = number,
                    .name = line.name,
                    .patch = line.patch,
                    .document = lineDocument(options_.start, line.patch),
                    .targets = line.targets.empty() ? options_.targets : line.targets,
                    .converge = line.converge.value_or(options_.converge)};
        for (std::size_t i = 0; i < job.targets.size(); ++i)
            if (auto error = wrongTarget(job.targets[i])) return wrong("targets[" + std::to_string(i) + "]", *error);

        // The document as the server gets it: a file's scene is known by its hash.
        Json document = job.document;
        if (Json& scene = document["scene"]; scene.is_array() && scene.size() == 2 && scene[0] == "file" && scene[1].is_string()) {
            const std::string path = options_.folder / scene[1].get<std::string>();
            const std::string sha256 = hashOfFile(path);
            if (sha256.empty()) return wrong("patch.scene[1]", "cannot read " + path);
            job.document["scene"] = {"file", path};
            scene = {"asset", sha256};
        }
        if (const auto checked = protocol::applyPatch(Json::object(), document, {}, true); !checked)
            return wrong("patch." + checked.error().field, checked.error().message);
        Json all = {kKeyVersion, document, job.targets, job.converge, Json::array()};
        for (const Format format : options_.formats) all.back().push_back(nameOf(format));
        const std::string text = all.dump();
        job.key = hashOf({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
        return job;
    }

 private:
    static Wrong wrong(std::string field, std::string message) {
        return tl::make_unexpected(LineError{std::move(field), std::move(message)});
    }

    std::optional<std::string> wrongTarget(const std::string& target) const {
        std::string known = "composite, spectral, bands";
        for (const auto& pass : options_.passes) known += ", " + pass;
        const bool own = target == "composite" || target == "spectral" || target == "bands";
        if (!own && std::ranges::find(options_.passes, target) == options_.passes.end())
            return "there is no '" + target + "' to draw; there are: " + known;
        if (std::ranges::none_of(options_.formats, [&](Format f) { return holds(f, target); }))
            return target + (holds(Format::Png, target) ? " is a picture: add png to --format" : " holds numbers: add npy or exr to --format");
        return std::nullopt;
    }

    const std::string& hashOfFile(const std::string& path) {
        const auto [known, isNew] = files_.try_emplace(path);
        if (isNew) {
            std::ifstream in(path, std::ios::binary);
            const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
            if (!bytes.empty()) known->second = hashOf(bytes);
        }
        return known->second;
    }

    const PlanOptions& options_;
    std::set<std::string> names_;
    std::map<std::string, std::string> files_;  // path and hash
};

}  // namespace

BatchPlan planBatch(std::istream& in, const PlanOptions& options) {
    BatchPlan plan;
    Planner planner(options);
    std::string text;
    for (int number = 1; std::getline(in, text); ++number) {
        if (text.find_first_not_of(" \t\r") == text.npos) continue;
        auto line = parseBatchLine(text, number);
        if (!line) {
            plan.bad.push_back({number, {}, line.error()});
            continue;
        }
        auto job = planner.job(*line, number);
        if (job) plan.jobs.push_back(std::move(*job));
        else plan.bad.push_back({number, line->name, job.error()});
    }
    return plan;
}

}  // namespace caustream::shot
