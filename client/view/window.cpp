#include "client/view/window.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <stdexcept>

#include "client/view/theme.h"

namespace caustream::view {
namespace {

std::string lastGlfwError() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "no reason given";
}

void onDrop(GLFWwindow* window, int count, const char** paths) {
    auto* self = static_cast<Window*>(glfwGetWindowUserPointer(window));
    if (self->dropped) self->dropped({paths, paths + count});
}

void onKey(GLFWwindow* window, int key, int, int action, int) {
    auto* self = static_cast<Window*>(glfwGetWindowUserPointer(window));
    if (self->pressed && action == GLFW_PRESS) self->pressed(key);
}

}  // namespace

Window::Window(const char* title, int width, int height) {
    if (!glfwInit())
        throw std::runtime_error(
            "cannot open a window: " + lastGlfwError() +
            "; is there a display? Without one, caustream-shot or the browser page shows pictures");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_ = glfwCreateWindow(width, height, title, nullptr, nullptr);
    if (!window_) {
        const std::string why = lastGlfwError();
        glfwTerminate();
        throw std::runtime_error("cannot open a window with OpenGL 3.3: " + why +
                                 "; install libgl1-mesa-dri, or use caustream-shot or the browser page");
    }
    glfwSetWindowUserPointer(window_, this);
    glfwSetDropCallback(window_, onDrop);
    glfwSetKeyCallback(window_, onKey);  // before Dear ImGui's, which calls it in turn
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    float scaleY = 1.0f;
    glfwGetWindowContentScale(window_, &scale_, &scaleY);
    scale_ = std::clamp(scale_, 1.0f, 4.0f);

    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // leaves no files behind
    applyTheme(scale_);
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

Window::~Window() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

bool Window::open() const {
    return !glfwWindowShouldClose(window_);
}

void Window::close() {
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Window::setTitle(const std::string& title) {
    glfwSetWindowTitle(window_, title.c_str());
}

void Window::waitEvents(double longestS) {
    if (longestS > 0.0)
        glfwWaitEventsTimeout(longestS);
    else
        glfwPollEvents();
}

void Window::wake() {
    glfwPostEmptyEvent();
}

void Window::beginFrame() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Window::endFrame() {
    int width = 0, height = 0;
    framebufferSize(width, height);
    glViewport(0, 0, width, height);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glfwSwapBuffers(window_);
}

void Window::framebufferSize(int& width, int& height) const {
    glfwGetFramebufferSize(window_, &width, &height);
}

double Window::seconds() {
    return glfwGetTime();
}

}  // namespace caustream::view
