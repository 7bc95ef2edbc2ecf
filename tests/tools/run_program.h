// Runs one of the project's programs and collects its output.
#pragma once
#include "tests/tools/temporary_folder.h"

#include <cstdlib>
#include <sys/wait.h>

struct ProgramRun
{
    int exit_code = -1; // 128 + signal where it was killed
    std::string out, err;
};

/// `arguments` go to the shell as they are: quote what needs it.
inline ProgramRun runProgram(const std::string& program, const std::string& arguments)
{
    const TemporaryFolder folder;
    const std::string out = (folder / "out").string();
    const std::string err = (folder / "err").string();
    const int status = std::system(("'" + program + "' " + arguments + " >" + out + " 2>" + err).c_str());
    ProgramRun run;
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    run.out = fileBytes(out);
    run.err = fileBytes(err);
    return run;
}
