# SPDX-License-Identifier: Apache-2.0
# Whether replay_page.html was made of the sources in this folder and not changed since, told
# without making it:
#
#   cmake -P check_page.cmake
#
# The page's first comment holds the SHA-256 over the sources and of all that follows, as build.mjs
# computes them. All before the sums is compared word by word.
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

set(page ${folder}/../replay_page.html)
set(sum "[0-9a-f]+")
string(CONCAT form
  "^(<!doctype html>\n<!--\nSPDX-License-Identifier: Apache-2.0\n"
  "Made from io/replay/page by \"./dev page\"; do not edit.\n"
  "SHA-256 of the sources: (${sum})\nSHA-256 of what follows this line: (${sum})\n)")
file(READ ${page} start LIMIT 1000)
if(NOT start MATCHES "${form}")
  message(FATAL_ERROR "replay_page.html: its first comment is not the one that build.mjs writes")
endif()
set(sources ${CMAKE_MATCH_2})
set(told ${CMAKE_MATCH_3})
string(LENGTH "${CMAKE_MATCH_1}" length)
if(NOT sources STREQUAL found)
  message(FATAL_ERROR "replay_page.html was made of other sources; \"./dev page\" makes it anew\n"
                      "  sources now: ${found}\n  in the page: ${sources}")
endif()
file(READ ${page} rest OFFSET ${length})
string(SHA256 found "${rest}")
if(NOT told STREQUAL found)
  message(FATAL_ERROR "replay_page.html was changed by hand; \"./dev page\" makes it anew\n"
                      "  sum now: ${found}\n  in the page: ${told}")
endif()
