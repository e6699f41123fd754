#include "bench/stream/server_child.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "error.h"
#include "tests/e2e/raw_client.h"

namespace caustream::bench {

ServerChild::ServerChild(const std::string& program, std::vector<std::string> options) {
    if (!std::filesystem::exists(program)) throw Error("no server at " + program + "; build caustream-server, or say --server PROGRAM");
    options.insert(options.begin(), {"--port", "0", "--log-level", "error"});
    process_ = std::make_unique<e2e::Background>(program, options);
    const std::string line = process_->firstLine();
    const auto colon = line.rfind(':');
    if (!line.starts_with("ready ") || colon == std::string::npos) {
        throw Error("the server did not come up; run it by hand to see why: " + program);
    }
    port_ = std::atoi(line.c_str() + colon + 1);
}

bool ServerChild::alive() const {
    // A child that has ended stays as a zombie until it is waited for.
    std::ifstream file("/proc/" + std::to_string(process_->pid()) + "/stat");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto name = text.rfind(')');
    return name != std::string::npos && name + 2 < text.size() && text[name + 2] != 'Z' && text[name + 2] != 'X';
}

double ServerChild::residentMib() const {
    std::ifstream file("/proc/" + std::to_string(process_->pid()) + "/statm");
    double total = 0, resident = 0;
    file >> total >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

int ServerChild::descriptors() const {
    std::error_code ended;
    const std::filesystem::directory_iterator all("/proc/" + std::to_string(process_->pid()) + "/fd", ended);
    return ended ? 0 : static_cast<int>(std::distance(all, std::filesystem::directory_iterator{}));
}

std::optional<double> ServerChild::metric(const std::string& name) const {
    std::istringstream text(e2e::httpGet(port_, "/metrics"));
    for (std::string line; std::getline(text, line);) {
        if (line.starts_with(name + " ")) return std::atof(line.c_str() + name.size() + 1);
    }
    return std::nullopt;
}

std::string serverBesideUs() { return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "caustream-server"; }

}  // namespace caustream::bench
