# SPDX-License-Identifier: Apache-2.0
# cmake -D SOURCE=FOLDER -D OUTPUT=FILE -P commit.cmake: writes the commit of a source tree as C++, with
# "-modified" where files differ from it, or "unknown" outside git. A file that would stay the same is
# left alone, so that only another commit builds anything again.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND git rev-parse --show-cdup WORKING_DIRECTORY ${SOURCE}
                OUTPUT_VARIABLE up RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
set(commit unknown)
if(failed STREQUAL "0" AND up STREQUAL "") # not within another project's tree
  execute_process(COMMAND git describe --always --abbrev=12 --exclude=* --dirty=-modified
                  WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE described ERROR_QUIET
                  OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(described)
    set(commit ${described})
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "// Written by cmake/commit.cmake.
namespace tool {
extern const char kCommit[];
const char kCommit[] = \"@commit@\";
}  // namespace tool
" @ONLY)
