# SPDX-License-Identifier: Apache-2.0
# Doxygen's view of a header, line for line: the comment below `#pragma once` is the file's, where an
# empty line ends it, and indented lines below an empty one of a comment are shown as they are.
{ line[NR] = $0 }
/^#pragma once/ { pragma = NR }
END {
  for (first = pragma + 1; first <= NR && line[first] == ""; ++first) {}
  for (last = first; line[last] ~ /^\/\/\//; ++last) {}
  isOfFile = pragma && last > first && line[last] == ""
  for (i = 1; i <= NR; ++i) {
    text = line[i]
    if (text !~ /^ *\/\/\/   /) shown = 0
    else if (line[i - 1] ~ /^ *\/\/\/$/) shown = 1
    if (shown) sub(/\/\/\/ /, "///     ", text)
    if (isOfFile && i == first - 1) text = "/// @file"
    print text
  }
}
