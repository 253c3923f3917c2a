#pragma once

namespace plumb::harness {

/// From now on the first interrupt (Ctrl-C, SIGTERM) only sets a flag; the second ends the program with 130.
void catch_interrupts();

/// Whether an interrupt came.
bool interrupted();

}  // namespace plumb::harness
