// lumicut-compare merge: adds up parts of a reference.
#pragma once

namespace CLI
{
class App;
}

/// The subcommand "merge"; its callback sets `exit_code` and runs it.
void addMergeCommand(CLI::App& app, int& exit_code);
