// caustream-shot: frames of a caustream server to files, without a window.
#include <cstdio>

#include "client/shot/batch.h"
#include "client/shot/options.h"
#include "client/shot/replay.h"
#include "client/shot/shoot.h"

int main(int argc, char** argv) {
    const auto options = caustream::shot::parseOptions(argc, argv);
    if (!options) {
        std::fputs(options.error().text.c_str(), options.error().exitCode == 0 ? stdout : stderr);
        return options.error().exitCode;
    }
    if (!options->batch.empty()) return caustream::shot::runBatch(*options);
    if (!options->replay.empty()) return caustream::shot::runReplay(*options);
    const auto written = caustream::shot::shoot(*options);
    if (!written) {
        std::fprintf(stderr, "caustream-shot: %s\n", written.error().c_str());
        return 1;
    }
    std::printf("%s\n", written->c_str());
    return 0;
}
