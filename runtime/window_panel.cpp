#include "runtime/window_panel.h"

#include <imgui.h>

#include <algorithm>

namespace
{
void text(const std::string& line)
{
    ImGui::TextUnformatted(line.data(), line.data() + line.size());
}

void showFacts(const PanelFacts& facts)
{
    text(std::string(facts.device));
    text(fmt::format("{} x {}, {} samples a pixel", facts.width, facts.height, facts.sample_count));
    text(fmt::format("{:8.2f} ms a frame ({:.1f} a second)", facts.frame_ms,
                     facts.frame_ms > 0 ? 1000 / facts.frame_ms : 0));
    for (const StageTime& stage : facts.stages)
        text(fmt::format("{:8.2f} ms {}", stage.ms, stage.name));
}

void chooseMode(Mode& mode)
{
    int index = int(mode);
    ImGui::RadioButton("gi", &index, int(Mode::kGi));
    ImGui::SameLine();
    ImGui::RadioButton("direct", &index, int(Mode::kDirect));
    ImGui::SameLine();
    ImGui::RadioButton("reference", &index, int(Mode::kReference));
    mode = Mode(index);
}

std::optional<size_t> chooseCamera(std::span<const Camera> cameras)
{
    std::optional<size_t> chosen;
    for (size_t i = 0; i < cameras.size(); ++i)
    {
        const std::string name = cameras[i].name.empty() ? fmt::format("camera {}", i) : cameras[i].name;
        if (ImGui::Selectable(fmt::format("{}##{}", name, i).c_str()))
            chosen = i;
    }
    return chosen;
}

/// @return whether it changed
bool editSetting(const Setting& setting, uint32_t& value)
{
    const std::string name(setting.name);
    if (setting.choices.empty())
    {
        const uint32_t least = uint32_t(setting.least), most = uint32_t(setting.most);
        return ImGui::SliderScalar(name.c_str(), ImGuiDataType_U32, &value, &least, &most, nullptr,
                                   ImGuiSliderFlags_AlwaysClamp | (most > 100 ? ImGuiSliderFlags_Logarithmic : 0));
    }
    const std::string items = choiceNames(setting, std::string_view("\0", 1)) +
                              '\0'; // ImGui wants each name ended by a zero, and the list by one more
    int index = int(value);
    const bool changed = ImGui::Combo(name.c_str(), &index, items.c_str());
    value = uint32_t(index);
    return changed;
}

bool editSetting(const Setting& setting, float& value)
{
    const std::string name(setting.name), format = setting.unit.empty() ? "%.3g" : fmt::format("%.2f {}", setting.unit);
    return ImGui::SliderFloat(name.c_str(), &value, float(setting.least), float(setting.most), format.c_str(),
                              ImGuiSliderFlags_AlwaysClamp);
}

/// Whether the setting decides only how the samples are shown.
bool isDisplaySetting(const Setting& setting)
{
    return setting.member == decltype(setting.member)(&Settings::exposure) ||
           setting.member == decltype(setting.member)(&Settings::tonemap);
}

bool editSettings(Settings& settings)
{
    bool restart = false;
    ImGui::PushItemWidth(ImGui::GetFontSize() * 10);
    for (const Setting& setting : allSettings())
    {
        const bool changed =
            std::visit([&](auto member) { return editSetting(setting, settings.*member); }, setting.member);
        restart |= changed &&
                   (!isDisplaySetting(setting) || settings.view != gpu::kViewNone); // views hold what is behind them
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("%s", std::string(setting.help).c_str());
    }
    ImGui::PopItemWidth();
    return restart;
}

std::string nameOf(AnimationChoice choice, std::span<const std::string> clips)
{
    using What = AnimationChoice::What;
    return choice.what == What::kClip ? clips[choice.clip] : choice.what == What::kAll ? "all" : "none";
}

void chooseAnimation(std::span<const std::string> clips, Playback& playback)
{
    using What = AnimationChoice::What;
    if (!ImGui::BeginCombo("animation", nameOf(playback.choice, clips).c_str()))
        return;
    const auto offer = [&](AnimationChoice choice)
    {
        const std::string label = fmt::format("{}##{}-{}", nameOf(choice, clips), int(choice.what), choice.clip);
        if (!ImGui::Selectable(label.c_str(), playback.choice == choice))
            return;
        playback.choice = choice;
        playback.seconds = 0;
    };
    for (uint32_t clip = 0; clip < clips.size(); ++clip)
        offer({What::kClip, clip});
    offer({What::kAll});
    offer({What::kNone});
    ImGui::EndCombo();
}

void editPlayback(const PanelFacts& facts, Playback& playback)
{
    ImGui::PushItemWidth(ImGui::GetFontSize() * 10);
    chooseAnimation(facts.clips, playback);
    if (ImGui::Button(playback.plays ? "pause" : "play"))
        playback.plays = !playback.plays;
    for (const auto& [label, step] : {std::pair{"<", -Playback::kFrame}, std::pair{">", Playback::kFrame}})
    {
        ImGui::SameLine();
        if (ImGui::Button(label))
            playback.step(step, facts.duration);
    }
    ImGui::SameLine();
    ImGui::Checkbox("loop", &playback.loops);
    float seconds = float(playback.seconds);
    if (ImGui::SliderFloat("seconds", &seconds, 0, float(facts.duration), "%.3f", ImGuiSliderFlags_AlwaysClamp))
        playback.seconds = seconds;
    ImGui::SliderFloat("speed", &playback.speed, 0.05f, 8, "%.2f x", ImGuiSliderFlags_Logarithmic);
    ImGui::PopItemWidth();
}
} // namespace

PanelActions drawPanel(const PanelFacts& facts, Settings& settings, Mode& mode, Playback& playback)
{
    PanelActions actions;
    ImGui::SetNextWindowPos({8, 8}); // fixed: a window made small for a moment must not push it out
    // No keyboard navigation: Tab and the arrows belong to the window.
    ImGui::Begin("Lumicut", nullptr,
                 ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoFocusOnAppearing);
    showFacts(facts);
    ImGui::Separator();
    chooseMode(mode);
    actions.restart = editSettings(settings);
    if (!facts.clips.empty())
    {
        ImGui::Separator();
        editPlayback(facts, playback);
    }
    ImGui::Separator();
    actions.camera = chooseCamera(facts.cameras);
    ImGui::Separator();
    text(
        fmt::format("WASD QE fly at {:.3g} m/s (wheel, Shift)\n"
                    "drag looks, 1-9 cameras, R records a path\nSpace pauses animations, N the next, arrows , . steps\n"
                    "F1 panel, F12 screenshot, Esc quits",
                    facts.speed));
    if (!facts.notice.empty())
        text(std::string(facts.notice));
    ImGui::End();
    return actions;
}
