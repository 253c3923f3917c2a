#pragma once

namespace plumb::harness {

/// Makes the first interrupt (Ctrl-C, SIGTERM) only set a flag; the second ends the program with 130.
void catch_interrupts();

/// Returns true if an interrupt came.
bool interrupted();

}  // namespace plumb::harness
