#include "tools/cli/documentation.h"

#include <fmt/format.h>

#include <array>
#include <sstream>

namespace
{
constexpr std::array kPrograms{"lumicut-bench", "lumicut-compare", "lumicut-compile",
                               "lumicut-pkg",   "lumicut-play",    "lumicut-scenes"};

/// Text for roff: a hyphen is one that can be copied, and no line begins with a control character.
std::string escaped(const std::string& text)
{
    std::string out;
    bool line_start = true;
    for (const char c : text)
    {
        if (line_start && (c == '.' || c == '\''))
            out += "\\&";
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
        line_start = c == '\n';
    }
    return out;
}

std::string bold(const std::string& text)
{
    return "\\fB" + escaped(text) + "\\fR";
}

std::string italic(const std::string& text)
{
    return "\\fI" + escaped(text) + "\\fR";
}

void addOptions(const CLI::App& app, std::string& page)
{
    for (const OptionText& option : optionTexts(app))
    {
        page += ".TP\n";
        for (size_t i = 0; i < option.names.size(); ++i)
            page += (i > 0 ? ", " : "") + bold(option.names[i]);
        if (!option.argument.empty())
            page += (option.names.empty() ? "" : " ") + italic(option.argument);
        page += "\n" + escaped(option.description) + "\n";
        if (!option.choices.empty())
            page += ".br\n" + escaped(fmt::format("One of {}.", fmt::join(option.choices, ", "))) + "\n";
    }
}

std::string synopsis(const CLI::App& app, const std::string& name)
{
    std::string line = ".B " + escaped(name) + "\n[" + italic("OPTION") + "]...";
    for (const OptionText& option : optionTexts(app))
        if (option.names.empty())
        {
            const std::string argument = italic(option.argument) + (option.several ? "..." : "");
            line += option.required ? " " + argument : " [" + argument + "]";
        }
    return line + "\n";
}

/// Laid out by spaces, as --help prints it.
void addPreformatted(const std::string& text, std::string& page)
{
    if (!text.empty())
        page += ".SH NOTES\n.nf\n" + escaped(text) + "\n.fi\n";
}

/// The description as one clause, for the line that apropos(1) shows.
std::string firstClause(const std::string& description)
{
    return description.substr(0, description.find_first_of(".:\n"));
}
} // namespace

std::string manualPage(const CLI::App& app)
{
    const std::string name = app.get_name();
    std::string upper = name;
    for (char& c : upper)
        c = char(std::toupper(static_cast<unsigned char>(c)));
    std::string page =
        fmt::format(".TH {} 1 \"\" \"Lumicut {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n",
                    escaped(upper), LUMICUT_VERSION, escaped(name), escaped(firstClause(app.get_description())));
    const std::vector<const CLI::App*> commands = app.get_subcommands([](const CLI::App*) { return true; });
    if (commands.empty())
        page += synopsis(app, name);
    for (size_t i = 0; i < commands.size(); ++i)
        page += (i > 0 ? ".br\n" : "") + synopsis(*commands[i], name + " " + commands[i]->get_name());
    page += ".SH DESCRIPTION\n" + escaped(app.get_description()) + "\n.SH OPTIONS\n";
    addOptions(app, page);
    if (!commands.empty())
        page += ".SH COMMANDS\n";
    for (const CLI::App* command : commands)
    {
        page += ".SS " + escaped(command->get_name()) + "\n" + escaped(command->get_description()) + ".\n";
        addOptions(*command, page);
    }
    addPreformatted(app.get_footer(), page);
    page += ".SH SEE ALSO\n";
    std::string others;
    for (const char* program : kPrograms)
        if (name != program)
            others += (others.empty() ? "" : ",\n") + fmt::format(".BR {} (1)", escaped(program));
    return page + others + "\n";
}
