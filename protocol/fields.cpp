#include "protocol/fields.h"

#include <array>
#include <charconv>
#include <cmath>

namespace caustream::protocol {
namespace {

const Json kNothing;  // stands in for what is absent

std::string shown(double value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    return {digits.data(), end.ptr};
}

std::string range(double min, double max) {
    return shown(min) + " to " + shown(max);
}

}  // namespace

std::string Item::path() const {
    std::string path = parent_ ? parent_->path() : std::string();
    if (!key_.empty()) return path.empty() ? std::string(key_) : path + "." + std::string(key_);
    return parent_ ? path + "[" + std::to_string(index_) + "]" : path;
}

void Item::fail(ErrorCode code, std::string message) const {
    if (!decoding_->error) decoding_->error = DecodeError{code, std::move(message), path(), std::nullopt};
}

double Item::number(double min, double max) const {
    if (!value_->is_number()) {
        fail(ErrorCode::BadRequest, "must be a number");
        return 0.0;
    }
    const double number = value_->get<double>();
    if (std::isfinite(number) && number >= min && number <= max) return number;
    fail(ErrorCode::OutOfRange, "must be a finite number, " + range(min, max));
    return 0.0;
}

std::uint64_t Item::integer(std::uint64_t min, std::uint64_t max) const {
    const auto outOfRange = [&]() -> std::uint64_t {
        fail(ErrorCode::OutOfRange, "must be an integer, " + std::to_string(min) + " to " + std::to_string(max));
        return 0;
    };
    std::uint64_t number = 0;
    if (value_->is_number_unsigned()) {
        number = value_->get<std::uint64_t>();
    } else if (value_->is_number_float()) {
        // Some writers print 512 as 512.0: the same number, so it is taken.
        const double exact = value_->get<double>();
        if (!(std::abs(exact) <= double(kMaxSafeInteger))) return outOfRange();
        if (exact != std::floor(exact)) {
            fail(ErrorCode::BadRequest, "must be an integer");
            return 0;
        }
        if (exact < 0.0) return outOfRange();
        number = static_cast<std::uint64_t>(exact);
    } else if (value_->is_number_integer()) {  // negative, as it is not unsigned; or built in memory
        const std::int64_t whole = value_->get<std::int64_t>();
        if (whole < 0) return outOfRange();
        number = static_cast<std::uint64_t>(whole);
    } else {
        fail(ErrorCode::BadRequest, "must be an integer");
        return 0;
    }
    return number >= min && number <= max ? number : outOfRange();
}

bool Item::boolean() const {
    if (value_->is_boolean()) return value_->get<bool>();
    fail(ErrorCode::BadRequest, "must be true or false");
    return false;
}

std::string Item::text(std::size_t maxBytes, std::size_t minBytes) const {
    const std::string* text = value_->get_ptr<const std::string*>();
    if (!text) {
        fail(ErrorCode::BadRequest, "must be a text");
        return {};
    }
    if (text->size() >= minBytes && text->size() <= maxBytes) return *text;
    fail(ErrorCode::OutOfRange,
         "must be a text of " + std::to_string(minBytes) + " to " + std::to_string(maxBytes) + " bytes");
    return {};
}

std::string Item::sha256() const {
    std::string digits = text(64, 64);
    if (digits.find_first_not_of("0123456789abcdef") == std::string::npos) return digits;
    fail(ErrorCode::BadRequest, "must be a SHA-256 as 64 lower-case hex digits");
    return {};
}

Json Item::object() const {
    if (value_->is_object()) return *value_;
    fail(ErrorCode::BadRequest, "must be an object");
    return Json::object();
}

std::size_t Item::size(std::size_t min, std::size_t max) const {
    if (!value_->is_array()) {
        fail(ErrorCode::BadRequest, "must be an array");
        return 0;
    }
    if (value_->size() >= min && value_->size() <= max) return value_->size();
    fail(ErrorCode::BadRequest,
         "must have " + std::to_string(min) + (min == max ? "" : " to " + std::to_string(max)) + " elements");
    return 0;
}

Vec3 Item::vec3(double min, double max) const {
    Vec3 vector{};
    const std::size_t count = size(3, 3);
    for (std::size_t i = 0; i < count; ++i) vector[i] = (*this)[i].number(min, max);
    return vector;
}

Vec3 Item::direction() const {
    const Vec3 vector = vec3(-1e6, 1e6);
    if (std::hypot(vector[0], vector[1], vector[2]) < 1e-6)
        fail(ErrorCode::OutOfRange, "must not be (nearly) 0, 0, 0: it is a direction");
    return vector;
}

std::vector<double> Item::ascending(std::size_t minCount, std::size_t maxCount, double min, double max,
                                    std::size_t first) const {
    std::vector<double> values;
    const std::size_t count = size(minCount + first, maxCount + first);
    values.reserve(count);
    for (std::size_t i = first; i < count; ++i) {
        const double value = (*this)[i].number(min, max);
        if (!values.empty() && value <= values.back()) (*this)[i].fail(ErrorCode::BadRequest, "must ascend");
        values.push_back(value);
    }
    return values;
}

std::vector<std::string> Item::texts(std::size_t maxCount, std::size_t maxBytes) const {
    std::vector<std::string> list;
    const std::size_t count = size(0, maxCount);
    list.reserve(count);
    for (std::size_t i = 0; i < count; ++i) list.push_back((*this)[i].text(maxBytes));
    return list;
}

Fields::Fields(const Item& item) : item_(item) {
    if (!item.json().is_object()) item.fail(ErrorCode::BadRequest, "must be an object");
}

std::optional<Item> Fields::find(std::string_view key) {
    asked_.push_back(key);
    const Json& json = item_.json();
    if (!json.is_object()) return std::nullopt;
    const auto member = json.find(key);
    if (member == json.end() || member->is_null()) return std::nullopt;
    return Item(&*member, &item_, key, 0, item_.decoding());
}

Item Fields::at(std::string_view key) {
    if (const std::optional<Item> item = find(key)) return *item;
    const Item absent(&kNothing, &item_, key, 0, item_.decoding());
    absent.fail(ErrorCode::BadRequest, "is missing");
    return absent;
}

void Fields::beStrict(bool strict) {
    item_.decoding().strict = strict;
}

void Fields::finish() const {
    if (!item_.decoding().strict || !item_.json().is_object()) return;
    for (const auto& [key, value] : item_.json().get_ref<const Json::object_t&>())
        if (std::find(asked_.begin(), asked_.end(), key) == asked_.end())
            Item(&value, &item_, key, 0, item_.decoding()).fail(ErrorCode::UnknownField, "is not a known field");
}

}  // namespace caustream::protocol
