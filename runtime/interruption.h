// Signals that ask the program to end, heard between two steps of its work.
#pragma once

/// From here on SIGINT, SIGTERM and SIGHUP are only noted. Whoever does not end within kPatienceSeconds of the first one is
/// ended, with code 128 + N and without the files that are open. A second one of a kind ends the program as ever.
/// A mapped file that vanishes, with the share that it lies on, ends it with kIo.
void noteInterruptions();
inline constexpr unsigned kPatienceSeconds = 3; // a farm asks for 5, with time to spare for a loaded machine

/// The signal that came first since then; 0: none.
int interruption();
