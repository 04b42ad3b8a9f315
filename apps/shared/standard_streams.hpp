// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Standard output and error of a program, and the signals that writing can bring.

#include <cstdio>
#include <string>

namespace softgauss::app {

/// To be called first. A write that would end the process by SIGPIPE or SIGXFSZ fails instead, with
/// a reason; what is closed of the three standard streams is opened to where nothing can be written
/// (standard error: to nowhere), so that no file gets its number.
void prepareStreams();

/// Writes to a stream as far as that goes. A failure of standard output is found by
/// finishStandardOutput(); one of standard error has nobody to be told to.
void print(std::FILE* stream, const std::string& text);

/// A message on standard error, as io::printable() has it.
void tell(const std::string& message);

/// To be called last: 0 once all of standard output is written; else tells why not and returns 2.
int finishStandardOutput(const std::string& program);

}  // namespace softgauss::app
