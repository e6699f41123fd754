// One direction of a network path: bytes pass one after the other at a rate, then take a while to arrive. No sockets, and
// the clock is the caller's; `nowUs` never runs backwards.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

namespace caustream::bench {

struct LinkShape {
    double bytesPerS = 0;         // 0: as fast as they come
    std::uint64_t delayUs = 0;    // one way
};

class Link {
   public:
    // From now on; what is under way arrives as it would have.
    void reshape(LinkShape shape, std::uint64_t nowUs);

    // Bytes that may enter now: what the rate allows, while no more is held than a link of this length holds.
    std::size_t room(std::uint64_t nowUs);
    void enter(std::string_view bytes, std::uint64_t nowUs);  // at most room()

    // The oldest bytes that have arrived and were not taken; empty: none. leave() takes from their front.
    std::string_view arrived(std::uint64_t nowUs) const;
    void leave(std::size_t bytes);

    // When room() or arrived() will say more than now, if nothing else happens; 0: never.
    std::uint64_t nextUs(std::uint64_t nowUs);

    std::uint64_t passed() const { return passed_; }  // bytes, since it was made

   private:
    double burst() const;
    void earn(std::uint64_t nowUs);
    bool full() const;

    struct Piece {
        std::string bytes;
        std::uint64_t arrivesUs;
    };
    LinkShape shape_;
    double tokens_ = 0;
    std::uint64_t lastUs_ = 0;
    std::deque<Piece> pieces_;
    std::size_t held_ = 0, taken_ = 0;   // taken: of the front piece
    std::uint64_t passed_ = 0;
};

}  // namespace caustream::bench
