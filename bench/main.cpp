#include <cstdio>
#include <exception>

#include "bench/commands.h"

int main(int argc, char** argv) {
    using namespace caustream::bench;
    CLI::App app{"caustream-bench: prints what frames cost. Quote ratios of one run, not milliseconds of different machines."};
    app.require_subcommand(1);
    addConverge(app);
    addEncode(app);
    addErrorVsTime(app);
    addEstimate(app);
    addFrame(app);
    addOmissions(app);
    addPeers(app);
    addReference(app);
    addSegments(app);
    addStability(app);
    addStream(app);
    addTiles(app);
    try {
        app.parse(argc, argv);   // runs the command
        return 0;
    } catch (const CLI::ParseError& error) {
        return app.exit(error);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "caustream-bench: %s\n", error.what());
        return 1;
    }
}
