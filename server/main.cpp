#include <csignal>
#include <cstdio>
#include <exception>

#include "config.h"
#include "error.h"
#include "gl/context.h"
#include "plan_report.h"
#include "service.h"
#include "supervise.h"

namespace {

// Before any thread starts, so that all inherit it and only supervise() sees these.
sigset_t blockStopSignals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    return signals;
}

void printGpus() {
    for (const caustream::gl::GpuInfo& gpu : caustream::gl::listGpus()) {
        std::printf("%d  %s%s\n", gpu.index, gpu.name.c_str(), gpu.software ? "  (software)" : "");
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const auto config = caustream::parseCommandLine(argc, argv);
        if (!config) {
            return 0;
        }
        if (config->gpu == "list") {
            printGpus();
            return 0;
        }
        caustream::log::setLevel(config->logLevel);
        if (!config->planScene.empty()) {
            std::fputs(caustream::planReport(*config).c_str(), stdout);
            return 0;
        }
        const sigset_t stopSignals = blockStopSignals();

        caustream::Service service(*config);
        std::printf("ready %s://%s:%d/\n", config->tlsCert.empty() ? "http" : "https", config->bind.c_str(), service.port());
        std::fflush(stdout);

        caustream::supervise(service, stopSignals, *config);
        return 0;
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "caustream-server: %s\n", problem.what());
        return 1;
    }
}
