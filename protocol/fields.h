// Reading JSON that cannot be trusted: every getter checks type and range, the first failure is kept, and what follows
// a failure reads as zero. Nothing wraps, truncates or clamps.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/state.h"

namespace caustream::protocol {

inline constexpr std::uint64_t kMaxSafeInteger = (1ull << 53) - 1;  // the largest that every JSON reader keeps exact
inline constexpr std::uint32_t kMaxU32 = std::numeric_limits<std::uint32_t>::max();

struct Decoding {
    bool strict = false;
    std::optional<DecodeError> error;  // the first
};

template <class T>
struct Choice {
    std::string_view name;
    T value;
};

// One value and where it stands. Holds pointers only: the document, the parent item and the Decoding outlive it.
class Item {
 public:
    Item(const Json* value, const Item* parent, std::string_view key, std::size_t index, Decoding& decoding)
        : value_(value), parent_(parent), key_(key), index_(index), decoding_(&decoding) {}
    Item(const Json& root, Decoding& decoding) : Item(&root, nullptr, {}, 0, decoding) {}

    const Json& json() const { return *value_; }
    Decoding& decoding() const { return *decoding_; }
    std::string path() const;  // "camera.eye[1]"
    void fail(ErrorCode code, std::string message) const;

    double number(double min, double max) const;
    std::uint64_t integer(std::uint64_t min, std::uint64_t max) const;
    std::uint32_t u32(std::uint32_t min = 0, std::uint32_t max = kMaxU32) const {
        return static_cast<std::uint32_t>(integer(min, max));
    }
    int integerInt(int min, int max) const { return static_cast<int>(u32(std::uint32_t(min), std::uint32_t(max))); }
    bool boolean() const;
    std::string text(std::size_t maxBytes, std::size_t minBytes = 0) const;
    std::string sha256() const;  // 64 lower-case hex digits
    Json object() const;         // a copy

    // Elements; 0 when it is no array, or one of the wrong length.
    std::size_t size(std::size_t min, std::size_t max) const;
    Item operator[](std::size_t index) const { return {&(*value_)[index], this, {}, index, *decoding_}; }
    Vec3 vec3(double min, double max) const;
    Vec3 direction() const;  // a vec3 that is not (0, 0, 0)
    std::vector<double> ascending(std::size_t minCount, std::size_t maxCount, double min, double max,
                                  std::size_t first = 0) const;
    std::vector<std::string> texts(std::size_t maxCount, std::size_t maxBytes) const;

    template <class T, std::size_t N>
    T oneOf(const Choice<T> (&choices)[N]) const {
        const std::string name = text(128);
        for (const Choice<T>& choice : choices)
            if (choice.name == name) return choice.value;
        std::string known;
        for (const Choice<T>& choice : choices) known += (known.empty() ? "" : ", ") + std::string(choice.name);
        fail(ErrorCode::Unsupported, "unknown choice; there is " + known);
        return choices[0].value;
    }

 private:
    const Json* value_;
    const Item* parent_;
    std::string_view key_;
    std::size_t index_;
    Decoding* decoding_;
};

// The members of an object. Remembers which were asked for, so that strict decoding can name the others.
class Fields {
 public:
    explicit Fields(const Item& item);
    Fields(const Fields&) = delete;
    Fields& operator=(const Fields&) = delete;

    std::optional<Item> find(std::string_view key);  // nothing where absent or null
    Item at(std::string_view key);                   // fails where absent
    void beStrict(bool strict);                      // from here on; members asked for before count too
    void finish() const;                             // strict: fails on members nobody asked for
    const Item& item() const { return item_; }

 private:
    Item item_;
    std::vector<std::string_view> asked_;
};

template <class T, std::size_t N>
std::string_view nameOf(const Choice<T> (&choices)[N], T value) {
    for (const Choice<T>& choice : choices)
        if (choice.value == value) return choice.name;
    return {};
}

}  // namespace caustream::protocol
