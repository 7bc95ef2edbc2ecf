#include "tools/cli/documentation.h"

#include <fmt/format.h>

#include <algorithm>

namespace
{
/// CLI11 states the values of IsMember() and CheckedTransformer() in the type's name: "TEXT:{gi,direct}" or
/// "ENUM:value in {text->0,json->1} OR {0,1}".
std::vector<std::string> choicesIn(const std::string& type)
{
    std::vector<std::string> choices;
    const size_t from = type.find('{');
    const size_t to = type.find('}');
    if (from == std::string::npos || to == std::string::npos || to < from)
        return choices;
    for (const std::string& item : CLI::detail::split(type.substr(from + 1, to - from - 1), ','))
        choices.push_back(item.substr(0, item.find("->")));
    return choices;
}

std::string argumentOf(const CLI::Option& option)
{
    if (option.get_items_expected() == 0)
        return {};
    if (option.get_positional())
        return option.get_name(true, false);
    std::string name = option.get_lnames().empty() ? "value" : option.get_lnames()[0];
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    return name;
}
} // namespace

std::vector<OptionText> optionTexts(const CLI::App& app)
{
    std::vector<OptionText> texts;
    for (const CLI::Option* option : app.get_options())
    {
        if (option->get_group().empty())
            continue;
        OptionText text;
        for (const std::string& name : option->get_snames())
            text.names.push_back("-" + name);
        for (const std::string& name : option->get_lnames())
            text.names.push_back("--" + name);
        text.argument = argumentOf(*option);
        text.choices = choicesIn(option->get_type_name());
        text.description = option->get_description();
        if (!option->get_default_str().empty() && text.description.find("default") == std::string::npos)
            text.description += fmt::format(" (default: {})", option->get_default_str());
        text.required = option->get_required();
        text.several = option->get_items_expected_max() > 1;
        texts.push_back(std::move(text));
    }
    return texts;
}

void addDocumentation(CLI::App& app)
{
    app.add_flag_callback("--manual",
                          [&app]
                          {
                              fmt::print("{}", manualPage(app));
                              throw CLI::Success();
                          })
        ->group(""); // hidden from --help
    app.add_option_function<std::string>("--completion",
                                         [&app](const std::string& shell)
                                         {
                                             fmt::print("{}", completion(app, shell));
                                             throw CLI::Success();
                                         })
        ->check(CLI::IsMember({"bash", "zsh", "fish"}))
        ->group("");
}
