// What the driver says: recorded, never printed; groups that name the passes in a debugger.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace caustream::gl {

// Starts recording messages of the current context.
void installDebugRecorder();

// Errors, undefined behaviour, deprecations and portability warnings since the last call; performance chatter is left out.
std::vector<std::string> takeDebugMessages();

// Scope that a debugger shows under `name`.
class DebugGroup {
   public:
    explicit DebugGroup(std::string_view name);
    ~DebugGroup();
    DebugGroup(const DebugGroup&) = delete;
    DebugGroup& operator=(const DebugGroup&) = delete;
};

}  // namespace caustream::gl
