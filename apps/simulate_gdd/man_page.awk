# SPDX-License-Identifier: Apache-2.0
# Makes the man page of simulate_gdd of what it prints for --help-all: one source for both.
#   simulate_gdd --help-all | awk -v version=0.1.0 -f man_page.awk

function escaped(text) {
  gsub(/\\/, "\\e", text)
  gsub(/-/, "\\-", text)
  sub(/^[.']/, "\\\\\\&&", text)
  return text
}

BEGIN {
  print ".TH SIMULATE_GDD 1 \"\" \"softgauss " version "\" \"User commands\""
  print ".SH NAME\nsimulate_gdd \\- simulate a robot under goal directed dynamics"
  print ".SH SYNOPSIS\n.B simulate_gdd\n.I MODEL\n[\\fIoptions\\fR]"
  print ".SH DESCRIPTION"
}

/^Usage:/ { inOptions = 1; print ".SH OPTIONS"; next }
/^[[:space:]]*$/ { next }
!inOptions { print escaped($0); next }
/^[A-Z][A-Za-z]*:$/ { sub(/:$/, ""); print ".SS " $0; next }

# "  --name WHAT          text", or the name alone with the text below it.
/^  [^ ]/ {
  line = substr($0, 3)
  text = ""
  if (match(line, /   *[^ ]/)) {
    text = substr(line, RSTART + RLENGTH - 1)
    line = substr(line, 1, RSTART - 1)
  }
  name = line
  sub(/ .*/, "", name)
  print ".TP\n\\fB" escaped(name) "\\fR" escaped(substr(line, length(name) + 1))
  if (text != "") print escaped(text)
  next
}
{ sub(/^ +/, ""); print escaped($0) }

END {
  print ".SH EXIT STATUS"
  print ".TP\n0\ndone"
  print ".TP\n1\nan internal error"
  print ".TP\n2\nbad usage or bad input; the message names the file, the line and the element"
  print ".TP\n3\nthe simulation became non\\-finite, or a solver could not continue; all output up to"
  print "the last good step is written"
  print ".TP\n130\ninterrupted; all output is written"
  print ".SH EXAMPLES"
  print ".EX\nsimulate_gdd robot.urdf \\-\\-reach hand=0.4,0.1,0.9 \\-\\-view motion.html"
  print "simulate_gdd robot.urdf \\-\\-explain\n.EE"
}
