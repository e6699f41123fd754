// Sets a program's uniforms by name; a name the program does not use is ignored, as GLSL compilers drop unused ones.
#pragma once
#include <epoxy/gl.h>

#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <span>
#include <string>

namespace caustream::gl {

class Uniforms {
   public:
    explicit Uniforms(GLuint program) : program_(program) {}

    const Uniforms& set(const char* name, int v) const { return glProgramUniform1i(program_, at(name), v), *this; }
    const Uniforms& set(const char* name, unsigned v) const { return glProgramUniform1ui(program_, at(name), v), *this; }
    const Uniforms& set(const char* name, bool v) const { return set(name, v ? 1 : 0); }
    const Uniforms& set(const char* name, float v) const { return glProgramUniform1f(program_, at(name), v), *this; }
    const Uniforms& set(const char* name, const glm::vec2& v) const {
        return glProgramUniform2fv(program_, at(name), 1, glm::value_ptr(v)), *this;
    }
    const Uniforms& set(const char* name, const glm::vec3& v) const {
        return glProgramUniform3fv(program_, at(name), 1, glm::value_ptr(v)), *this;
    }
    const Uniforms& set(const char* name, const glm::vec4& v) const {
        return glProgramUniform4fv(program_, at(name), 1, glm::value_ptr(v)), *this;
    }
    const Uniforms& set(const char* name, const glm::ivec2& v) const {
        return glProgramUniform2iv(program_, at(name), 1, glm::value_ptr(v)), *this;
    }
    const Uniforms& set(const char* name, const glm::mat3& v) const {
        return glProgramUniformMatrix3fv(program_, at(name), 1, GL_FALSE, glm::value_ptr(v)), *this;
    }
    const Uniforms& set(const char* name, const glm::mat4& v) const {
        return glProgramUniformMatrix4fv(program_, at(name), 1, GL_FALSE, glm::value_ptr(v)), *this;
    }
    const Uniforms& set(const char* name, std::span<const float> v) const {
        return glProgramUniform1fv(program_, at(name), static_cast<GLsizei>(v.size()), v.data()), *this;
    }
    const Uniforms& set(const char* name, std::span<const glm::vec4> v) const {
        return glProgramUniform4fv(program_, at(name), static_cast<GLsizei>(v.size()), glm::value_ptr(v[0])), *this;
    }

   private:
    GLint at(const char* name) const { return glGetUniformLocation(program_, name); }
    GLuint program_;
};

}  // namespace caustream::gl
