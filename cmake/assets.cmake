# SPDX-License-Identifier: Apache-2.0
# Files as bytes of a program, which then needs no path to them.

# hc_write_assets(OUTPUT HEADER NAMESPACE FUNCTION FILE …): the source file behind a header that
# declares `std::span<const std::byte> FUNCTION();` for each file.
function(hc_write_assets output header namespace)
  set(source "#include <${header}>\n\nnamespace ${namespace} {\n")
  set(words ${ARGN})
  while(words)
    list(POP_FRONT words function file)
    set(file ${CMAKE_CURRENT_SOURCE_DIR}/${file})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} bytes HEX)
    string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
    string(APPEND source
           "std::span<const std::byte> ${function}() {\n"
           "  static const unsigned char bytes[] = {\n${bytes}};\n"
           "  return std::as_bytes(std::span(bytes));\n}\n")
  endwhile()
  file(WRITE ${output}.new "${source}}  // namespace ${namespace}\n")
  configure_file(${output}.new ${output} COPYONLY)
endfunction()
