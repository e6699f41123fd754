// A GLFW window with an OpenGL 3.3 context and Dear ImGui on it. Throws std::runtime_error: what, and what to try.
#pragma once
#include <functional>
#include <string>
#include <vector>

struct GLFWwindow;

namespace caustream::view {

class Window {
 public:
    Window(const char* title, int width, int height);
    ~Window();
    Window(const Window&) = delete;

    // Called from within waitEvents(): files were dropped; a key (GLFW_KEY_...) went down. Dear ImGui would miss a key
    // that is up again before the next frame.
    std::function<void(const std::vector<std::string>&)> dropped;
    std::function<void(int)> pressed;

    bool open() const;
    void close();
    void setTitle(const std::string& title);
    // Until something happens or someone calls wake(), at most this long.
    void waitEvents(double longestS);
    static void wake();  // any thread

    void beginFrame();  // Dear ImGui's
    void endFrame();    // draws its windows, swaps
    float scale() const { return scale_; }
    void framebufferSize(int& width, int& height) const;
    static double seconds();

 private:
    GLFWwindow* window_ = nullptr;
    float scale_ = 1.0f;
};

}  // namespace caustream::view
