# caustream_embed(<target> <name> <file>...): a static library that holds the files' bytes and a header
# "embedded/<name>.h" with
#   namespace caustream::embedded { std::span<const File> <name>(); }   // File{name, bytes}, see embedded/file.h
# A file's name is its path below BASE (an absolute folder; default: the calling folder). Files made at build time work too.

function(caustream_embed target name)
  cmake_parse_arguments(arg "" "BASE" "FILES" ${ARGN})
  if(NOT arg_BASE)
    set(arg_BASE ${CMAKE_CURRENT_SOURCE_DIR})
  endif()
  set(dir ${CMAKE_CURRENT_BINARY_DIR}/embedded_${name})
  set(include ${dir}/include/embedded)
  file(MAKE_DIRECTORY ${include})
  file(CONFIGURE OUTPUT ${include}/file.h @ONLY CONTENT [=[
#pragma once
#include <span>
#include <string_view>
namespace caustream::embedded {
struct File {
    std::string_view name;
    std::string_view bytes;
};
}  // namespace caustream::embedded
]=])
  file(CONFIGURE OUTPUT ${include}/${name}.h @ONLY CONTENT [=[
#pragma once
#include "embedded/file.h"
namespace caustream::embedded {
std::span<const File> @name@();
}
]=])
  set(assembly "")
  set(externs "")
  set(rows "")
  set(index 0)
  foreach(file IN LISTS arg_FILES)
    file(RELATIVE_PATH label ${arg_BASE} ${file})
    set(symbol embedded_${name}_${index})
    string(APPEND assembly ".global ${symbol}\n.global ${symbol}_end\n${symbol}:\n.incbin \"${file}\"\n${symbol}_end:\n.byte 0\n")
    string(APPEND externs "extern const char ${symbol}[], ${symbol}_end[];\n")
    string(APPEND rows "        {\"${label}\", {${symbol}, static_cast<std::size_t>(${symbol}_end - ${symbol})}},\n")
    math(EXPR index "${index} + 1")
  endforeach()
  file(CONFIGURE OUTPUT ${dir}/${name}.S CONTENT ".section .rodata\n${assembly}.section .note.GNU-stack,\"\",@progbits\n" @ONLY)
  file(CONFIGURE OUTPUT ${dir}/${name}.cpp @ONLY CONTENT [=[
#include "embedded/@name@.h"
extern "C" {
@externs@}
namespace caustream::embedded {
std::span<const File> @name@() {
    static const File files[] = {
@rows@    };
    return files;
}
}  // namespace caustream::embedded
]=])
  set_source_files_properties(${dir}/${name}.S PROPERTIES OBJECT_DEPENDS "${arg_FILES}")
  add_library(${target} STATIC ${dir}/${name}.S ${dir}/${name}.cpp)
  target_include_directories(${target} PUBLIC ${dir}/include)
endfunction()
