// caustream-view: a window on a caustream server.
#include <cstdio>
#include <exception>

#include "client/view/app.h"

int main(int argc, char** argv) {
    auto options = caustream::view::parseOptions(argc, argv);
    if (!options) {
        std::fputs(options.error().text.c_str(), options.error().exitCode == 0 ? stdout : stderr);
        return options.error().exitCode;
    }
    try {
        caustream::view::App(std::move(*options)).run();
        return 0;
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "caustream-view: %s\n", problem.what());
        return 1;
    }
}
