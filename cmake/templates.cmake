# SPDX-License-Identifier: Apache-2.0
# Files as strings of a program: what `hc new` writes is found wherever hc was installed.

# hc_embed(VARIABLE FUNCTION PATH FILE …): appends a function that gives pairs of a path in what is
# begun, and the text of a file of templates/.
function(hc_embed variable function)
  set(source "std::vector<TemplateFile> ${function}() {\n  return {\n")
  set(words ${ARGN})
  while(words)
    list(POP_FRONT words path file)
    set(file ${PROJECT_SOURCE_DIR}/templates/${file})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} content)
    string(APPEND source "      {\"${path}\", R\"hc_text(${content})hc_text\"},\n")
  endwhile()
  string(APPEND source "  };\n}\n")
  set(${variable} "${${variable}}${source}" PARENT_SCOPE)
endfunction()

# hc_write_templates(FILE): the source file behind tools/hc/templates.h.
function(hc_write_templates output)
  hc_embed(text cpp_template CMakeLists.txt outside/CMakeLists.txt README.md outside/README.md
           main.cpp module/main.cpp cases/multiplies/in module/cases/multiplies/in
           cases/multiplies/out module/cases/multiplies/out)
  hc_embed(text python_template @NAME@ python/module @NAME@_test.py python/test.py
           README.md python/README.md)
  file(WRITE ${output}.new "#include \"templates.h\"\n\nnamespace tool {\n${text}}  // namespace tool\n")
  configure_file(${output}.new ${output} COPYONLY)
endfunction()
