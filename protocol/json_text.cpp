#include "protocol/json_text.h"

#include <string>
#include <utility>
#include <vector>

namespace caustream::protocol {
namespace {

// Builds the value as the parser reports it; stops at the first thing wrong.
class Builder : public nlohmann::json_sax<Json> {
 public:
    explicit Builder(std::size_t maxDepth) : maxDepth_(maxDepth) {}

    Json root;
    std::string problem;

    bool null() override { return put(nullptr); }
    bool boolean(bool value) override { return put(value); }
    bool number_integer(number_integer_t value) override { return put(value); }
    bool number_unsigned(number_unsigned_t value) override { return put(value); }
    bool number_float(number_float_t value, const string_t&) override { return put(value); }
    bool string(string_t& value) override { return put(std::move(value)); }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open(Json::object()); }
    bool end_object() override { return close(); }
    bool start_array(std::size_t) override { return open(Json::array()); }
    bool end_array() override { return close(); }
    bool key(string_t& name) override {
        const auto [member, isNew] = open_.back()->get_ref<Json::object_t&>().try_emplace(name);
        member_ = &member->second;
        if (!isNew) problem = "the key \"" + name.substr(0, 64) + "\" appears twice in one object";
        return isNew;
    }
    bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
        const bool isRange = error.id == 406;
        problem = (isRange ? "a number beyond a double's range ends at byte " : "not JSON at byte ") +
                  std::to_string(position);
        return false;
    }

 private:
    // Elements of an open array may move when it grows, but only its last one is ever open.
    Json* place(Json value) {
        if (open_.empty()) return &(root = std::move(value));
        if (open_.back()->is_array()) return &open_.back()->emplace_back(std::move(value));
        return &(*member_ = std::move(value));
    }
    bool put(Json value) { return place(std::move(value)) != nullptr; }
    bool open(Json value) {
        if (open_.size() >= maxDepth_) {
            problem = "nested deeper than " + std::to_string(maxDepth_);
            return false;
        }
        open_.push_back(place(std::move(value)));
        return true;
    }
    bool close() {
        open_.pop_back();
        return true;
    }

    std::size_t maxDepth_;
    std::vector<Json*> open_;
    Json* member_ = nullptr;  // of the innermost open object, waiting for its value
};

}  // namespace

tl::expected<Json, DecodeError> parseText(std::string_view text, std::size_t maxBytes, std::size_t maxDepth) {
    if (text.size() > maxBytes)
        return tl::unexpected(DecodeError{
            ErrorCode::TooLarge,
            "the message has " + std::to_string(text.size()) + " bytes, the limit is " + std::to_string(maxBytes),
            {},
            {}});
    // The parser takes a NUL for the end of its input and would not look at what follows.
    if (text.find('\0') != std::string_view::npos)
        return tl::unexpected(DecodeError{ErrorCode::BadMessage, "the message holds a NUL byte", {}, {}});
    Builder builder(maxDepth);
    if (Json::sax_parse(text, &builder)) return std::move(builder.root);
    return tl::unexpected(DecodeError{ErrorCode::BadMessage, builder.problem, {}, {}});
}

}  // namespace caustream::protocol
