#include "bench/vs_thesis.h"

#include <cstdio>
#include <map>
#include <sstream>

#include "bench/accuracy/tables.h"

namespace caustream::bench {

namespace {

using render::kContinuous;

// What is measured on every scene. Gap fill as published; of one wavelength there are no gaps.
struct Column {
    std::string name;
    render::Mode mode;
    int wavelengths;
};
const std::vector<Column> kColumns = {
    {"thesis 1", render::Mode::Thesis, 1},   {"thesis 7", render::Mode::Thesis, 7},   {"thesis 21", render::Mode::Thesis, 21},
    {"refined 1", render::Mode::Refined, 1}, {"refined 7", render::Mode::Refined, 7}, {"refined 21", render::Mode::Refined, 21},
    {"continuous", render::Mode::Refined, kContinuous},
};

Configuration configurationOf(const Column& column, int lightView) {
    Configuration configuration;
    configuration.transport.mode = column.mode;
    configuration.transport.wavelengths = column.wavelengths;
    configuration.transport.gapFill = column.mode == render::Mode::Thesis && column.wavelengths > 1;
    configuration.transport.photonGrid = configuration.transport.mapSize = lightView;
    return configuration;
}

// One row of a table: every column on one subject, by the column's name.
struct Row {
    Subject subject;
    Truth truth;
    std::uint32_t photons = 0;         // of the published algorithm, and of ours for it
    std::map<std::string, Outcome> outcomes;

    const Outcome& at(const std::string& column) const { return outcomes.at(column); }
    double ratio(const std::string& slow, const std::string& fast) const { return at(slow).ms / at(fast).ms; }
};

// The rows' columns, ours with as many photons as the published algorithm finds; `fixed`: also "fixed 7", with as many as
// on the first row wherever the light is.
void measure(Study& study, const std::string& what, std::vector<Row>& rows, int lightView, bool fixed) {
    std::vector<Job> jobs;
    std::vector<std::pair<Row*, std::string>> places;
    for (Row& row : rows) {
        row.photons = study.photonsOf(row.subject, configurationOf(kColumns.front(), lightView));
        const auto add = [&](const std::string& name, Configuration configuration, std::uint32_t photons) {
            if (configuration.transport.mode == render::Mode::Refined) {
                configuration.transport.photonGrid = 180;
                configuration = study.withPhotons(row.subject, configuration, photons);
            }
            jobs.push_back({&row.subject, &row.truth, configuration});
            places.emplace_back(&row, name);
        };
        for (const Column& column : kColumns) add(column.name, configurationOf(column, lightView), row.photons);
        constexpr std::uint32_t kFixedPhotons = 25'500;   // a grid of 180 on the sphere
        if (fixed) add("fixed 7", configurationOf(kColumns[4], lightView), kFixedPhotons);
    }
    const std::vector<Outcome> outcomes = study.run(what, jobs);
    for (std::size_t i = 0; i < outcomes.size(); ++i) places[i].first->outcomes[places[i].second] = outcomes[i];
}

std::string timesTable(const std::vector<Row>& rows, const std::string& head, bool fixed) {
    std::vector<std::vector<std::string>> cells = {{head, "photons"}};
    for (const Column& column : kColumns) cells.front().push_back(column.name);
    if (fixed) cells.front().push_back("refined 7, 25,500 photons");
    cells.front().push_back("thesis 21 / continuous");
    for (const Row& row : rows) {
        cells.push_back({row.subject.name, format("%u", row.photons)});
        for (const Column& column : kColumns) cells.back().push_back(format("%.1f", row.at(column.name).ms));
        if (fixed) cells.back().push_back(format("%.1f", row.at("fixed 7").ms));
        cells.back().push_back(format("%.1f", row.ratio("thesis 21", "continuous")));
    }
    return table(cells);
}

std::string errorsTable(const std::vector<Row>& rows, const std::string& head) {
    std::vector<std::vector<std::string>> cells = {{head}};
    for (const Column& column : kColumns) cells.front().push_back(column.name);
    cells.front().push_back("the reference's own");
    for (const Row& row : rows) {
        cells.push_back({row.subject.name});
        for (const Column& column : kColumns) cells.back().push_back(format("%.3f", row.at(column.name).error.luminance));
        cells.back().push_back(format("%.3f", row.truth.luminanceNoise()));
    }
    return table(cells);
}

std::string claims(const Row& far, const Row& near) {
    std::string text;
    for (const Row* row : {&far, &near}) {
        const double faster = row->ratio("thesis 21", "continuous");
        const double thesis = row->at("thesis 21").error.luminance, ours = row->at("continuous").error.luminance;
        text += claim(faster >= 5.0 && ours < thesis, format("%s: continuous is %.1f times faster than thesis 21 (5 claimed), its error %.3f against %.3f, %u "
                                                            "photons both", row->subject.name.c_str(), faster, ours, thesis, row->photons));
    }
    for (const Row* row : {&far, &near}) {
        const double light = row->at("continuous").lightMs / row->at("refined 7").lightMs;
        text += claim(light <= 1.0, format("%s: continuous, light side over that of 7 exact wavelengths %.2f (1 claimed)", row->subject.name.c_str(), light));
        const double whole = row->ratio("continuous", "refined 1");
        text += claim(whole <= 1.6, format("%s: continuous, whole frame over that of one wavelength %.2f (1.6 claimed)", row->subject.name.c_str(), whole));
    }
    const double ours = near.at("fixed 7").ms / far.at("fixed 7").ms, theirs = near.at("thesis 7").ms / far.at("thesis 7").ms;
    text += claim(ours <= 1.3, format("from %s to %s, at an equal photon count: refined 7 grows %.2f times (1.3 claimed; thesis 7: %.2f, thesis 21: %.2f)",
                                      far.subject.name.c_str(), near.subject.name.c_str(), ours, theirs, near.at("thesis 21").ms / far.at("thesis 21").ms));
    return text;
}

// Table 4's scene: the built-in sphere is so near its light that it could not be 2.5% of any view of 120 degrees.
Subject farSphere() {
    Subject subject = loadSubject("reference:sphere");
    subject.name = "sphere over a floor";
    subject.fingerprint += " far";
    scene::Light& light = subject.scene.lights.front();
    const glm::vec3 centre = subject.scene.geometry->casterBounds.centre();
    light.position = centre + 1.6f * (light.position - centre);
    return subject;
}

}  // namespace

std::string vsThesis(Study& study, const VsThesisOptions& options) {
    std::vector<Row> scenes, shares;
    const std::vector<std::string> names = options.quick ? std::vector<std::string>{"sphere"}
                                                         : std::vector<std::string>{"sphere", "ring", "gem", "bunny", "glass"};
    for (const std::string& name : names) {
        Subject subject = loadSubject(name);
        Truth truth = study.truth(subject);
        scenes.push_back({.subject = std::move(subject), .truth = std::move(truth)});
    }
    const Subject sphere = farSphere();
    for (const double share : options.quick ? std::vector<double>{0.025, 0.33} : std::vector<double>{0.025, 0.04, 0.07, 0.13, 0.33}) {
        Subject subject = withShare(sphere, share);
        Truth truth = study.truth(subject);
        shares.push_back({.subject = std::move(subject), .truth = std::move(truth)});
    }
    measure(study, "scenes", scenes, options.lightView, false);
    measure(study, "shares of the light's view", shares, options.lightView, true);

    std::ostringstream text;
    text << "Milliseconds for a frame after a move of the light, median; numbers of wavelengths; equal photon counts in a row.\n\n"
         << timesTable(scenes, "table 3", false) << "\nRelative L1 of the map's luminance, the same frames:\n\n" << errorsTable(scenes, "table 3, error")
         << "\nAgainst the sphere's share of the light's view:\n\n" << timesTable(shares, "table 4", true) << "\n"
         << errorsTable(shares, "table 4, error") << "\n" << claims(shares.front(), shares.back());
    std::printf("\n%s", text.str().c_str());
    return text.str();
}

}  // namespace caustream::bench
