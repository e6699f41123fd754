#include "gl/debug.h"

#include <epoxy/gl.h>

#include <mutex>
#include <utility>

namespace caustream::gl {

namespace {
constexpr std::size_t kMostMessages = 64;  // a broken driver repeats itself every draw
std::mutex mutex;                          // drivers may call back from threads of their own
std::vector<std::string> messages;         // guarded by mutex

void GLAPIENTRY record(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* text, const void*) {
    const bool problem = type == GL_DEBUG_TYPE_ERROR || type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR ||
                         type == GL_DEBUG_TYPE_DEPRECATED_BEHAVIOR || type == GL_DEBUG_TYPE_PORTABILITY;
    if (!problem || severity == GL_DEBUG_SEVERITY_NOTIFICATION) return;
    const std::lock_guard lock(mutex);
    if (messages.size() < kMostMessages) messages.emplace_back(text, static_cast<std::size_t>(length));
}
}  // namespace

void installDebugRecorder() {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(record, nullptr);
}

std::vector<std::string> takeDebugMessages() {
    const std::lock_guard lock(mutex);
    return std::exchange(messages, {});
}

DebugGroup::DebugGroup(std::string_view name) {
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, static_cast<GLsizei>(name.size()), name.data());
}
DebugGroup::~DebugGroup() { glPopDebugGroup(); }

}  // namespace caustream::gl
