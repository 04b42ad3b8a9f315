// SPDX-License-Identifier: Apache-2.0
#include "apps/shared/interrupt.hpp"

#include <signal.h>

#include <initializer_list>

#include "softgauss/io/output.hpp"

namespace softgauss::app {
namespace {

volatile sig_atomic_t interruptRequested = 0;
volatile sig_atomic_t seen[NSIG] = {};

/// Ends the process as the signal does where nobody handles it.
void end(int number) {
  io::removePartFiles();
  signal(number, SIG_DFL);
  raise(number);
}

void endInOrder(int number) {
  if (seen[number]) end(number);
  seen[number] = 1;
  interruptRequested = 1;
}

void handle(int number, void (*handler)(int)) {
  struct sigaction before = {}, action = {};
  if (sigaction(number, nullptr, &before) != 0 || before.sa_handler != SIG_DFL) return;
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, nullptr);
}

}  // namespace

void catchInterrupts() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) handle(number, endInOrder);
  for (const int number : {SIGQUIT, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGUSR1, SIGUSR2, SIGABRT,
                           SIGSEGV, SIGBUS, SIGFPE, SIGILL})
    handle(number, end);
}

bool interrupted() { return interruptRequested != 0; }

void forgetInterrupts() {
  interruptRequested = 0;
  for (auto& one : seen) one = 0;
}

}  // namespace softgauss::app
