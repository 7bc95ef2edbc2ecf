#include "tools/cli/documentation.h"

#include <fmt/format.h>

#include <algorithm>

namespace
{
std::vector<const CLI::App*> commandsOf(const CLI::App& app)
{
    return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string names(const CLI::App& app)
{
    std::string all;
    for (const OptionText& option : optionTexts(app))
        for (const std::string& name : option.names)
            all += (all.empty() ? "" : " ") + name;
    return all;
}

std::string joined(const std::vector<std::string>& items, const char* between)
{
    return fmt::format("{}", fmt::join(items, between));
}

std::string functionName(const CLI::App& app)
{
    std::string name = "_" + app.get_name();
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

/// Values of `app`'s options: a case of bash for each option that has any.
std::string bashCases(const CLI::App& app)
{
    std::string cases;
    for (const OptionText& option : optionTexts(app))
        if (!option.names.empty() && !option.argument.empty())
            cases += option.choices.empty() // left to the shell, which completes names of files
                         ? fmt::format("    {}) return ;;\n", joined(option.names, "|"))
                         : fmt::format("    {}) COMPREPLY=($(compgen -W '{}' -- \"$cur\")); return ;;\n",
                                       joined(option.names, "|"), joined(option.choices, " "));
    return cases;
}

std::string bash(const CLI::App& app)
{
    const std::string function = functionName(app);
    std::string text = function + "()\n{\n    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]}\n"
                                  "    COMPREPLY=()\n";
    std::string words;
    text += "    case ${COMP_WORDS[1]} in\n";
    for (const CLI::App* command : commandsOf(app))
    {
        words += (words.empty() ? "" : " ") + command->get_name();
        if (const std::string cases = bashCases(*command); !cases.empty())
            text += fmt::format("    {})\n    case $prev in\n{}    esac ;;\n", command->get_name(), cases);
    }
    text += "    *) ;;\n    esac\n";
    if (const std::string cases = bashCases(app); !cases.empty())
        text += "    case $prev in\n" + cases + "    esac\n";
    if (!words.empty())
    {
        text += fmt::format(
            "    if [[ $COMP_CWORD == 1 ]]; then COMPREPLY=($(compgen -W '{} {}' -- \"$cur\")); return; fi\n", words,
            names(app));
        text += "    local options=\n    case ${COMP_WORDS[1]} in\n";
        for (const CLI::App* command : commandsOf(app))
            text += fmt::format("    {}) options='{}' ;;\n", command->get_name(), names(*command));
        text += "    *) ;;\n    esac\n";
    }
    else
        text += fmt::format("    local options='{}'\n", names(app));
    text += "    if [[ $cur == -* ]]; then COMPREPLY=($(compgen -W \"$options\" -- \"$cur\")); fi\n}\n";
    return text + fmt::format("complete -o default -F {} {}\n", function, app.get_name());
}

/// Inside single quotes, where zsh's _arguments gives brackets and colons a meaning.
std::string zshText(const std::string& text)
{
    std::string out;
    for (const char c : text)
    {
        if (c == '\'')
            out += "'\\''";
        else if (c == '[' || c == ']' || c == ':' || c == '\\')
            out += std::string("\\") + c;
        else
            out += c == '\n' ? ' ' : c;
    }
    return out;
}

std::string zshArguments(const CLI::App& app)
{
    std::string text;
    for (const OptionText& option : optionTexts(app))
    {
        const std::string action = option.choices.empty() ? "_files" : "(" + joined(option.choices, " ") + ")";
        for (const std::string& name : option.names)
            text += fmt::format(" \\\n    '{}[{}]{}'", name, zshText(option.description),
                                option.argument.empty() ? "" : ":" + zshText(option.argument) + ":" + action);
    }
    return "  _arguments" + text + " \\\n    '*:file:_files'\n";
}

std::string zsh(const CLI::App& app)
{
    std::string text = "#compdef " + app.get_name() + "\n\n";
    const auto commands = commandsOf(app);
    if (commands.empty())
        return text + zshArguments(app);
    text += "if (( CURRENT == 2 )); then\n  local -a commands=(\n";
    for (const CLI::App* command : commands)
        text += fmt::format("    '{}:{}'\n", command->get_name(), zshText(command->get_description()));
    text += "  )\n  _describe command commands\n" + zshArguments(app) +
            "  return\nfi\nlocal command=${words[2]}\n"
            "shift words\n(( CURRENT-- ))\ncase $command in\n";
    for (const CLI::App* command : commands)
        text += fmt::format("{})\n{}  ;;\n", command->get_name(), zshArguments(*command));
    return text + "esac\n";
}

std::string fishQuoted(const std::string& text)
{
    std::string out = "'";
    for (const char c : text)
        out += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c == '\n' ? ' ' : c);
    return out + "'";
}

std::string fishOptions(const CLI::App& app, const std::string& program, const std::string& condition)
{
    std::string text;
    for (const OptionText& option : optionTexts(app))
    {
        if (option.names.empty())
            continue;
        text += "complete -c " + program + condition;
        for (const std::string& name : option.names)
            text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        if (!option.argument.empty())
            text += option.choices.empty() ? " -r" : " -x -a " + fishQuoted(joined(option.choices, " "));
        text += " -d " + fishQuoted(option.description) + "\n";
    }
    return text;
}

std::string fish(const CLI::App& app)
{
    std::string text;
    const auto commands = commandsOf(app);
    for (const CLI::App* command : commands)
        text += fmt::format("complete -c {} -n __fish_use_subcommand -a {} -d {}\n", app.get_name(),
                            command->get_name(), fishQuoted(command->get_description()));
    text += fishOptions(app, app.get_name(), commands.empty() ? "" : " -n __fish_use_subcommand");
    for (const CLI::App* command : commands)
        text += fishOptions(*command, app.get_name(),
                            fmt::format(" -n '__fish_seen_subcommand_from {}'", command->get_name()));
    return text;
}
} // namespace

std::string completion(const CLI::App& app, const std::string& shell)
{
    return shell == "bash" ? bash(app) : shell == "zsh" ? zsh(app) : fish(app);
}
