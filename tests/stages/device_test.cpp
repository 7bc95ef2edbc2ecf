// The choice of a device and the settings of the command line: results and error messages.
#include "runtime/gpu/instance.h"
#include "runtime/settings.h"
#include "shaders/lib/terms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace
{
DeviceInfo device(uint32_t index, const std::string& name, const std::string& kind, std::vector<std::string> lacks = {})
{
    return {.index = index, .name = name, .kind = kind, .driver = "", .memory_bytes = 0, .lacks = std::move(lacks)};
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// A refusal by kDevice whose sentence holds all of `parts`.
void expectRefusal(const Result<uint32_t>& chosen, const std::vector<std::string>& parts)
{
    ASSERT_FALSE(chosen) << *chosen;
    EXPECT_EQ(chosen.error().code, ExitCode::kDevice);
    for (const std::string& part : parts)
        EXPECT_TRUE(contains(chosen.error().message, part)) << "'" << part << "' in: " << chosen.error().message;
}

TEST(SelectDevice, PrefersDiscreteThenIntegratedThenVirtualThenCpuInAnyOrderOfTheList)
{
    // The kinds in the order in which they are to be chosen, each device removed once it has been.
    std::vector<DeviceInfo> devices{device(4, "A", "discrete"), device(2, "B", "integrated"), device(0, "C", "virtual"),
                                    device(3, "D", "cpu"), device(1, "E", "other")};
    std::mt19937 random(1);
    while (!devices.empty())
    {
        for (int repeat = 0; repeat < 10; ++repeat)
        {
            std::vector<DeviceInfo> shuffled = devices;
            std::ranges::shuffle(shuffled, random);
            const auto chosen = selectDevice(shuffled, "");
            ASSERT_TRUE(chosen) << chosen.error().message;
            EXPECT_EQ(*chosen, devices.front().index);
        }
        devices.erase(devices.begin());
    }
}

TEST(SelectDevice, TakesTheFirstOfEqualKinds)
{
    const std::vector<DeviceInfo> devices{device(0, "A", "cpu"), device(1, "B", "discrete"),
                                          device(2, "C", "discrete")};
    const auto chosen = selectDevice(devices, "");
    ASSERT_TRUE(chosen);
    EXPECT_EQ(*chosen, 1u);
}

TEST(SelectDevice, PassesOverDevicesThatLackFeatures)
{
    const std::vector<DeviceInfo> devices{device(0, "Big", "discrete", {"scalarBlockLayout"}),
                                          device(1, "Small", "cpu")};
    for (const std::string selector : {"", "cpu", "1", "small"})
    {
        const auto chosen = selectDevice(devices, selector);
        ASSERT_TRUE(chosen) << selector << ": " << chosen.error().message;
        EXPECT_EQ(*chosen, 1u) << selector;
    }
}

TEST(SelectDevice, FindsByIndexByKindAndByPartOfTheNameInAnyCase)
{
    const std::vector<DeviceInfo> devices{device(0, "NVIDIA H200", "discrete"),
                                          device(1, "llvmpipe (LLVM 15, 256 bits)", "cpu"),
                                          device(2, "Intel Arc 770", "integrated")};
    const std::vector<std::pair<std::string, uint32_t>> cases{{"0", 0},    {"1", 1},    {"2", 2},      {"cpu", 1},
                                                              {"LLVM", 1}, {"h200", 0}, {"arc 77", 2}, {"(llvm 15", 1}};
    for (const auto& [selector, index] : cases)
    {
        const auto chosen = selectDevice(devices, selector);
        ASSERT_TRUE(chosen) << selector << ": " << chosen.error().message;
        EXPECT_EQ(*chosen, index) << selector;
    }
}

TEST(SelectDevice, ReadsDigitsAsAnIndexNeverAsAName)
{
    const std::vector<DeviceInfo> devices{device(0, "NVIDIA H200", "discrete")};
    expectRefusal(selectDevice(devices, "200"), {"no device matches '200'", "0: NVIDIA H200 (discrete)"});
    expectRefusal(selectDevice(devices, "99999999999999999999"), {"no device matches '99999999999999999999'"});
}

TEST(SelectDevice, SaysWhatEachDeviceLacks)
{
    const std::vector<DeviceInfo> devices{
        device(0, "Old", "discrete", {"Vulkan 1.3 (it offers 1.1): a newer driver is needed"}),
        device(1, "Odd", "integrated",
               {"synchronization2: barriers", "VK_KHR_push_descriptor: every kernel's buffers"})};
    const std::vector<std::string> all{
        "0: Old (discrete)", "lacks Vulkan 1.3 (it offers 1.1): a newer driver is needed", "1: Odd (integrated)",
        "lacks synchronization2: barriers", "lacks VK_KHR_push_descriptor: every kernel's buffers"};
    for (const std::string selector : {"", "0", "odd"})
    {
        SCOPED_TRACE(selector);
        expectRefusal(selectDevice(devices, selector), all);
        expectRefusal(selectDevice(devices, selector), {"no device can run this player"});
    }
    expectRefusal(selectDevice(devices, "cpu"), all);
    expectRefusal(selectDevice(devices, "cpu"), {"no device matches 'cpu'"});
}

TEST(SelectDevice, SaysWhatToInstallWhereThereIsNoDeviceAtAll)
{
    expectRefusal(selectDevice({}, ""), {"there is no Vulkan device at all", "mesa-vulkan-drivers"});
    expectRefusal(selectDevice({}, "cpu"), {"no device matches 'cpu'", "mesa-vulkan-drivers"});
}

// ---- Settings ------------------------------------------------------------------------------------------------------

void expectSettingRefused(const std::string& assignment, const std::vector<std::string>& parts)
{
    SCOPED_TRACE(assignment);
    Settings settings;
    const Status status = applySetting(settings, assignment);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ExitCode::kUsage);
    for (const std::string& part : parts)
        EXPECT_TRUE(contains(status.error().message, part)) << "'" << part << "' in: " << status.error().message;
    EXPECT_EQ(settings.exposure, Settings().exposure);
    EXPECT_EQ(settings.tonemap, Settings().tonemap);
    EXPECT_EQ(settings.direct_samples, Settings().direct_samples);
}

TEST(ApplySetting, ReachesEverySettingFromItsLeastToItsMost)
{
    for (const Setting& setting : allSettings())
        for (const double value : {setting.least, setting.most})
        {
            Settings settings;
            const Status status = applySetting(settings, fmt::format("{}={}", setting.name, value));
            if (!setting.choices.empty())
            {
                EXPECT_FALSE(status) << setting.name << " is chosen by name, not by number";
                continue;
            }
            ASSERT_TRUE(status) << status.error().message;
            std::visit(
                [&](auto member) {
                    EXPECT_EQ(settings.*member, std::remove_reference_t<decltype(settings.*member)>(value))
                        << setting.name;
                },
                setting.member);
        }
    Settings settings;
    for (const auto& [name, value] : {std::pair("srgb", 0u), std::pair("aces", 1u), std::pair("agx", 2u)})
    {
        ASSERT_TRUE(applySetting(settings, fmt::format("tonemap={}", name)));
        EXPECT_EQ(settings.tonemap, value) << name;
    }
    for (const Setting& setting : allSettings())
        for (const Choice& choice : setting.choices)
        {
            ASSERT_TRUE(applySetting(settings, fmt::format("{}={}", setting.name, choice.name)));
            EXPECT_EQ(settings.*std::get<uint32_t Settings::*>(setting.member), choice.value)
                << setting.name << "=" << choice.name;
        }
    for (const auto& [name, value] : {std::pair("all", gpu::kTermAll), std::pair("emission", gpu::kTermEmission),
                                      std::pair("direct", gpu::kTermDirect), std::pair("caustics", gpu::kTermCaustics),
                                      std::pair("indirect", gpu::kTermIndirect), std::pair("glossy", gpu::kTermGlossy)})
    {
        ASSERT_TRUE(applySetting(settings, fmt::format("term={}", name)));
        EXPECT_EQ(settings.term, value) << name;
    }
}

TEST(ApplySetting, ListsTheNamesWhereNoneMatches)
{
    std::vector<std::string> names;
    for (const Setting& setting : allSettings())
        names.emplace_back(setting.name);
    for (const std::string assignment : {"", "=", "nonsense=1", "exposure", "Exposure=1", " exposure=1", "=1"})
        expectSettingRefused(assignment, names);
}

TEST(ApplySetting, NamesTheRangeOfAValueOutsideIt)
{
    for (const Setting& setting : allSettings())
    {
        if (!setting.choices.empty())
        {
            expectSettingRefused(fmt::format("{}=nonsense", setting.name), {choiceNames(setting, ",")});
            continue;
        }
        const std::string range = fmt::format("{}..{}", setting.least, setting.most);
        for (const double value : {setting.least - 1, setting.most + 1, 1e300})
            expectSettingRefused(fmt::format("{}={}", setting.name, value), {std::string(setting.name), range});
        for (const std::string value : {"", "x", "1x", "nan", "inf", "1 ", "--1", "1,5"})
            expectSettingRefused(fmt::format("{}={}", setting.name, value), {std::string(setting.name), range});
        if (std::holds_alternative<uint32_t Settings::*>(setting.member))
            expectSettingRefused(fmt::format("{}={}", setting.name, setting.least + 0.5),
                                 {"a whole number in " + range});
    }
}

TEST(ApplySetting, KeepsTheOtherSettings)
{
    Settings settings;
    ASSERT_TRUE(applySetting(settings, "exposure=-1.5"));
    ASSERT_TRUE(applySetting(settings, "direct_samples=4"));
    EXPECT_EQ(settings.exposure, -1.5f);
    EXPECT_EQ(settings.direct_samples, 4u);
    EXPECT_EQ(settings.specular_depth, Settings().specular_depth);
    EXPECT_EQ(settings.reference_depth, Settings().reference_depth);
}
} // namespace
