#pragma once

namespace caustream::session {

// std::visit with one lambda per alternative.
template <class... Ts>
struct Overloaded : Ts... {
    using Ts::operator()...;
};

}  // namespace caustream::session
