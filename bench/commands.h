// What caustream-bench can do: each adds its subcommand, with options and what it runs. Everything prints; nothing asserts.
// A command that has failed throws Error, or CLI::RuntimeError with an exit status when all has been said.
#pragma once
#include <CLI/CLI.hpp>

namespace caustream::bench {

void addConverge(CLI::App& app);     // a viewer at rest: how soon the map is good
void addEncode(CLI::App& app);       // the ways from a drawn picture to a JPEG
void addErrorVsTime(CLI::App& app);   // error and time of many configurations
void addEstimate(CLI::App& app);      // the error estimate beside the true error
void addFrame(CLI::App& app);         // render times in this process
void addOmissions(CLI::App& app);     // what leaving out saves
void addPeers(CLI::App& app);        // POV-Ray beside traced transport
void addReference(CLI::App& app);     // exact maps from the CPU
void addSegments(CLI::App& app);    // what a ray segment of traced transport costs
void addStability(CLI::App& app);     // stiff, extreme and random scenes
void addStream(CLI::App& app);        // how frames reach their viewers
void addTiles(CLI::App& app);         // what changes from frame to frame

}  // namespace caustream::bench
