// Signals that ask the program to end, heard between two steps of its work.
#pragma once

/// From here on SIGINT, SIGTERM and SIGHUP are only noted. A second one of a kind ends the program as ever.
void noteInterruptions();

/// The signal that came first since then; 0: none.
int interruption();
