#include "client/shot/log_file.h"

#include <map>

#include "protocol/json_text.h"

namespace caustream::shot {
namespace {

using protocol::Json;

constexpr std::size_t kLineBytes = 1u << 20;  // a whole document, and more
constexpr std::size_t kDepth = 33;

template <class T>
T number(const Json& line, const char* key) {
    const auto found = line.find(key);
    return found != line.end() && found->is_number_unsigned() ? found->get<T>() : T{};
}

bool flag(const Json& line, const char* key) {
    const auto found = line.find(key);
    return found != line.end() && found->is_boolean() && found->get<bool>();
}

std::string textOf(const Json& line, const char* key) {
    const auto found = line.find(key);
    return found != line.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

tl::expected<Log, std::string> readLog(std::istream& in) {
    Log log;
    std::map<std::uint32_t, std::size_t> asked;  // steps that wait for their answer, by id
    std::string text;
    for (int at = 1; std::getline(in, text); ++at) {
        const auto wrong = [&](const std::string& why) { return tl::make_unexpected("line " + std::to_string(at) + ": " + why); };
        const bool last = in.eof();  // it has no line feed: the server was killed within it
        const auto line = protocol::parseText(text, kLineBytes, kDepth);
        if (!line && last) break;
        if (!line) return wrong(line.error().message);
        if (!line->is_object()) return wrong("a line must be a JSON object");
        if (at == 1) {
            if (number<int>(*line, "caustream_log") != 1) return wrong("this is no log of a caustream server, or one of another version");
            if (!line->contains("state") || !(*line)["state"].is_object()) return wrong("the document that it starts with is missing");
            log.state = (*line)["state"];
            log.build = textOf(*line, "build"), log.gpu = textOf(*line, "gpu");
            continue;
        }
        const std::string op = textOf(*line, "op");
        LogStep step{.number = at, .atUs = number<std::uint64_t>(*line, "t_us")};
        if (op == "update" || op == "input") {
            if (!line->contains("patch") || !(*line)["patch"].is_object()) return wrong("the patch is missing");
            step.kind = op == "update" ? LogStep::Kind::Update : LogStep::Kind::Input;
            step.patch = (*line)["patch"];
            step.seq = number<std::uint32_t>(*line, "seq");
            log.steps.push_back(std::move(step));
        } else if (op == "frame.request") {
            step.kind = LogStep::Kind::Request;
            step.id = number<std::uint32_t>(*line, "id");
            step.still = flag(*line, "still"), step.converge = flag(*line, "converge");
            asked[step.id] = log.steps.size();
            log.steps.push_back(std::move(step));
        } else if (op == "frame") {
            const auto of = asked.find(number<std::uint32_t>(*line, "id"));
            if (of == asked.end()) return wrong("an answer to a frame.request that is not there");
            log.steps[of->second].mapHash = textOf(*line, "map_hash");
            log.steps[of->second].photons = number<std::uint32_t>(*line, "photons");
            asked.erase(of);
        } else if (op == "end") {
            log.ended = true;
        } else {
            return wrong("op '" + op + "' is not known");
        }
    }
    if (log.state.is_null()) return tl::make_unexpected(std::string("it is empty"));
    return log;
}

}  // namespace caustream::shot
