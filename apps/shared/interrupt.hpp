// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Signals that end a run.

namespace softgauss::app {

/// From here on SIGINT, SIGTERM and SIGHUP end the run in order; the second of one kind ends it at
/// once, as other signals do, and then no output is left half written. What was ignored when the
/// program began, as nohup has it, stays so.
void catchInterrupts();

bool interrupted();
/// The run goes on with something else, which a signal ends as if it were the first.
void forgetInterrupts();

}  // namespace softgauss::app
