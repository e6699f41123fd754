// The buffers that the light's passes write, made and read back.
#pragma once
#include <array>
#include <vector>

#include "gl/names.h"
#include "shaders/shared/layout.h"

namespace caustream::tests {

inline std::vector<GLuint> readWords(const gl::Buffer& buffer) {
    std::vector<GLuint> words(buffer.bytes() / sizeof(GLuint));
    glGetNamedBufferSubData(buffer.get(), 0, static_cast<GLsizeiptr>(buffer.bytes()), words.data());
    return words;
}

inline gl::Buffer makeZeroed(std::size_t words, const char* label) {
    const std::vector<GLuint> zeros(words);
    return gl::Buffer(words * sizeof(GLuint), zeros.data(), GL_DYNAMIC_STORAGE_BIT, label);
}

inline gl::Buffer makeLedger() { return makeZeroed(layout::kLedgerBanks * layout::kLedgerRows, "ledger"); }

// The banks added up.
inline std::array<GLuint, layout::kLedgerRows> ledgerRows(const gl::Buffer& ledger) {
    std::array<GLuint, layout::kLedgerRows> rows{};
    const std::vector<GLuint> words = readWords(ledger);
    for (std::size_t i = 0; i < words.size(); ++i) rows[i % layout::kLedgerRows] += words[i];
    return rows;
}

}  // namespace caustream::tests
