# SPDX-License-Identifier: Apache-2.0
# Whether replay_page.html was made of the sources in this folder, told without making it:
#
#   cmake -P check_page.cmake
#
# The page's first comment holds the SHA-256 over the sources, as build.mjs computes it.
cmake_minimum_required(VERSION 3.25)

set(folder ${CMAKE_CURRENT_LIST_DIR})
file(GLOB_RECURSE paths RELATIVE ${folder} ${folder}/*)
list(SORT paths COMPARE STRING)
set(lines "")
foreach(path IN LISTS paths)
  file(SHA256 ${folder}/${path} hash)
  string(APPEND lines "${hash}  ${path}\n")
endforeach()
string(SHA256 found "${lines}")

file(READ ${folder}/../replay_page.html start LIMIT 400)
if(NOT start MATCHES "SHA-256 of the sources: ([0-9a-f]+)")
  message(FATAL_ERROR "replay_page.html: its first comment names no SHA-256 of its sources")
endif()
if(NOT CMAKE_MATCH_1 STREQUAL found)
  message(FATAL_ERROR "replay_page.html was made of other sources; \"./dev page\" makes it anew\n"
                      "  sources now: ${found}\n  in the page: ${CMAKE_MATCH_1}")
endif()
