// A screen that only memory sees, and a hand on its mouse.
#pragma once
#include <string>

#include "pixels.h"
#include "program.h"

namespace caustream::e2e {

class Display {
 public:
    Display(int width, int height);
    const std::string& name() const { return name_; }  // ":93"
    Environment environment() const;

    // What is on the screen now.
    Pixels look() const;
    // xdotool's words: {"mousemove", "10", "20"}.
    void hand(std::vector<std::string> words) const;
    // Presses a button at a place, moves in small steps, lets go; with a key held, if one is named.
    void drag(int x, int y, int dx, int dy, const std::string& key = "", int button = 1) const;

 private:
    TemporaryFolder folder_;
    Background xvfb_;
    std::string name_;
};

}  // namespace caustream::e2e
