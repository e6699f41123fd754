// Many configurations measured together: errors once, times in turns, so that what else the machine does hits all alike.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "bench/accuracy/configuration.h"
#include "bench/accuracy/journal.h"
#include "bench/accuracy/pareto.h"
#include "bench/accuracy/truth.h"

namespace caustream::bench {

struct StudySettings {
    std::string gpu = "auto";
    int rounds = 4;                // turns that every configuration gets
    int frames = 3;                // most counted in each, after one that is not
    TruthSettings truth;
};

struct Job {
    const Subject* subject = nullptr;
    const Truth* truth = nullptr;
    Configuration configuration;
};

struct Outcome {
    Configuration configuration;
    MapError error;
    double ms = 0, lightMs = 0;    // medians of whole frames after a move of the light, and of the light's side alone
    double spreadMs = 0;           // between the quartiles of the frames

    Cost cost() const { return {ms, error.luminance}; }
};

class Study {
   public:
    // `journal` keeps what is done: results of another build, GPU, scene, configuration or setting do not count.
    Study(Renderer& renderer, Journal& journal, StudySettings settings);

    const StudySettings& settings() const { return settings_; }
    // The subject's reference, traced or from the cache, with its progress on standard error.
    Truth truth(const Subject& subject);
    // One outcome a job, in their order.
    std::vector<Outcome> run(const std::string& what, const std::vector<Job>& jobs);
    // Photons a side with which `configuration` traces within 1% or so of `photons` photons.
    Configuration withPhotons(const Subject& subject, Configuration configuration, std::uint32_t photons);
    std::uint32_t photonsOf(const Subject& subject, const Configuration& configuration);

   private:
    nlohmann::json key(const Job& job, const std::string& kind) const;
    void time(const Job& job);

    Renderer& renderer_;
    Journal& journal_;
    StudySettings settings_;
    std::string build_;
    std::set<std::string> warm_;   // jobs whose pipeline has made its images
    int moves_ = 0;                // of lights so far, so that no frame finds its light in a cache
};

}  // namespace caustream::bench
