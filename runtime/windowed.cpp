#include "runtime/windowed.h"

#include "runtime/capture.h"
#include "runtime/opened_scene.h"
#include "runtime/path_recorder.h"
#include "runtime/window_overlay.h"
#include "runtime/window_panel.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace
{
using Clock = std::chrono::steady_clock;

float sceneSize(const SceneGpu& scene)
{
    const gpu::vec3 a = scene.info().bounds_min, b = scene.info().bounds_max;
    return std::max(std::hypot(b.x - a.x, b.y - a.y, b.z - a.z), 1e-3f);
}

/// `stem` and the first number with which there is no file of any of the extensions, in the current folder.
std::string freeName(const char* stem, std::initializer_list<const char*> extensions)
{
    for (uint32_t number = 1;; ++number)
    {
        const std::string name = fmt::format("{}-{:04}", stem, number);
        if (std::ranges::none_of(extensions,
                                 [&](const char* extension) { return std::filesystem::exists(name + extension); }))
            return name;
    }
}

/// What is on the screen and how it changes from frame to frame.
class WindowedPlayer
{
public:
    WindowedPlayer(const PlayerOptions& options, Window& window, const OpenedScene& opened, Swapchain& swapchain)
        : options_(options), settings_(opened.settings), window_(window), opened_(opened),
          swapchain_(swapchain), flights_{Flight(*opened.device), Flight(*opened.device)},
          overlay_(window, opened.instance, *opened.device, swapchain, flights_[0].rec),
          fly_(opened.camera(), sceneSize(*opened.scene)), follows_path_(opened.path.has_value())
    {
        playback_.choice = opened.plays;
        playback_.seconds = options.seconds.value_or(0);
        if (opened.animation)
            followed_camera_ = opened.camera_index;
    }

    Status play(Statistics& statistics);

private:
    Result<bool> fitSurface();
    void useKeys();
    bool playbackKey(int key);
    void saveScreenshot();
    void toggleRecording();
    void jump(size_t camera);
    void showMoment(Recorder& rec);
    double duration() const { return opened_.animation ? opened_.animation->duration(playback_.choice) : 0; }
    void moveCamera(float seconds);
    void usePanel();
    struct Flight // a frame that the GPU may still be at
    {
        explicit Flight(const Device& device) : rec(device) {}
        Recorder rec;
        bool submitted = false;
    };
    void land(Flight& flight, Statistics& statistics);
    void showFrame(Statistics& statistics);
    bool finished(uint32_t frames) const;
    Status makeRenderer();

    PlayerOptions options_; // its mode changes under the person's hands, and so do the settings
    Settings settings_;
    Window& window_;
    const OpenedScene& opened_;
    Swapchain& swapchain_;
    std::array<Flight, kFramesInFlight> flights_;
    uint32_t turn_ = 0; // of flights_
    WindowOverlay overlay_;
    FlyCamera fly_;
    bool follows_path_;
    double path_seconds_ = 0; // since its start
    Playback playback_;
    std::optional<size_t> followed_camera_; // of the package, as the animation moves it; none: it is flown by hand
    std::optional<PathRecorder> recorder_;
    std::optional<Renderer> renderer_;
    std::vector<StageTime> stages_;
    std::string notice_;
    Clock::time_point last_frame_ = Clock::now();
    double frame_ms_ = 0;
    bool panel_ = true;
};

Status WindowedPlayer::makeRenderer()
{
    opened_.device->waitIdle(); // frames in flight use the one there is
    const VkExtent2D extent = swapchain_.extent();
    return ::makeRenderer(renderer_, opened_, options_.mode, extent.width, extent.height, settings_);
}

/// @return false while there is nothing to draw on; kDevice where the window has become too large to render
Result<bool> WindowedPlayer::fitSurface()
{
    if (!swapchain_.resize(window_.size()))
        return false;
    const VkExtent2D extent = swapchain_.extent();
    if (!renderer_ || renderer_->width() != extent.width || renderer_->height() != extent.height)
        if (const Status status = makeRenderer(); !status)
            return status.error();
    return true;
}

void WindowedPlayer::saveScreenshot()
{
    const std::string name = freeName("screenshot", {".png", ".exr"});
    notice_ = fmt::format("wrote {}.png and .exr", name);
    for (const char* extension : {".png", ".exr"})
        if (const Status status =
                Capture(name + extension, *renderer_, *opened_.device, *opened_.scene, settings_).write();
            !status)
            notice_ = status.error().message;
    fmt::print(stderr, "{}\n", notice_);
}

void WindowedPlayer::toggleRecording()
{
    if (!recorder_)
    {
        recorder_.emplace(fly_.camera());
        notice_ = "records a path, R ends it";
        return;
    }
    const std::string name = freeName("path", {".json"}) + ".json";
    const Status status = recorder_->finish(fly_.camera()).save(name);
    recorder_.reset();
    notice_ = status ? fmt::format("wrote {}", name) : status.error().message;
    fmt::print(stderr, "{}\n", notice_);
}

void WindowedPlayer::jump(size_t camera)
{
    follows_path_ = false;
    fly_.jump(opened_.cameras[camera]);
    if (opened_.animation)
        followed_camera_ = camera;
}

/// The scene as it is now, and the camera that moves with it.
void WindowedPlayer::showMoment(Recorder& rec)
{
    if (!opened_.animation)
        return;
    opened_.animation->record(rec, playback_.choice, playback_.seconds);
    if (followed_camera_ && !follows_path_)
        fly_.jump(opened_.animation->posed(*followed_camera_, opened_.cameras[*followed_camera_]));
}

/// Along the path, over and over, until the person takes the camera; then by hand.
void WindowedPlayer::moveCamera(float seconds)
{
    const FlyInput input = window_.takeFlyInput(!overlay_.wantsKeyboard(), !overlay_.wantsMouse());
    follows_path_ &= !input.moves();
    if (input.moves())
        followed_camera_.reset();
    if (follows_path_)
    {
        const CameraPath& path = *opened_.path;
        path_seconds_ += seconds;
        const double round = path.end() - path.start();
        fly_.jump(path.at(path.start() + (round > 0 ? std::fmod(path_seconds_, round) : 0)));
    }
    fly_.move(input, seconds);
    if (recorder_)
        recorder_->add(fly_.camera(), seconds);
}

/// @return whether it is one of the animation's
bool WindowedPlayer::playbackKey(int key)
{
    constexpr double kJump = 0.1; // of the animation
    constexpr float kSlowest = 1 / 16.0f, kFastest = 16;
    if (key == GLFW_KEY_SPACE)
        playback_.plays = !playback_.plays;
    else if (key == GLFW_KEY_COMMA || key == GLFW_KEY_PERIOD)
        playback_.step(key == GLFW_KEY_COMMA ? -Playback::kFrame : Playback::kFrame, duration());
    else if (key == GLFW_KEY_LEFT || key == GLFW_KEY_RIGHT)
        playback_.step(key == GLFW_KEY_LEFT ? -kJump * duration() : kJump * duration(), duration());
    else if (key == GLFW_KEY_UP || key == GLFW_KEY_DOWN)
        playback_.speed = std::clamp(playback_.speed * (key == GLFW_KEY_UP ? 2 : 0.5f), kSlowest, kFastest);
    else if (key == GLFW_KEY_N)
        playback_ = {.choice = opened_.animation->after(playback_.choice),
                     .plays = playback_.plays,
                     .loops = playback_.loops,
                     .speed = playback_.speed};
    else
        return false;
    return true;
}

void WindowedPlayer::useKeys()
{
    for (const int key : window_.takeKeys())
    {
        if (overlay_.wantsKeyboard())
            continue;
        if (key == GLFW_KEY_ESCAPE)
            window_.close();
        else if (key == GLFW_KEY_F1 || key == GLFW_KEY_TAB)
            panel_ = !panel_;
        else if (key == GLFW_KEY_F12)
            saveScreenshot();
        else if (opened_.animation && playbackKey(key))
            continue;
        else if (key == GLFW_KEY_R)
            toggleRecording();
        else if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9 && size_t(key - GLFW_KEY_1) < opened_.cameras.size())
            jump(size_t(key - GLFW_KEY_1));
    }
}

void WindowedPlayer::usePanel()
{
    if (!panel_)
        return;
    const Mode mode = options_.mode;
    const Settings settings = settings_;
    const std::string device = opened_.device->name();
    const auto clips = opened_.animation ? std::span(opened_.animation->names()) : std::span<const std::string>();
    const PanelActions actions = drawPanel({.device = device,
                                            .width = renderer_->width(),
                                            .height = renderer_->height(),
                                            .sample_count = renderer_->sampleCount(),
                                            .frame_ms = frame_ms_,
                                            .stages = stages_,
                                            .cameras = opened_.cameras,
                                            .speed = fly_.speed(),
                                            .clips = clips,
                                            .duration = duration(),
                                            .notice = notice_},
                                           settings_, options_.mode, playback_);
    if (settings_.view == gpu::kViewError && opened_.against.pixels.empty())
    {
        settings_.view = settings.view;
        notice_ = kNothingToCompareWith;
    }
    if (actions.camera)
        jump(*actions.camera);
    const bool counts_changed = actions.restart && options_.mode == Mode::kGi; // they decide how much is allocated
    if (options_.mode == mode && !counts_changed && actions.restart)
        renderer_->restart();
    if (options_.mode == mode && !counts_changed)
        return;
    if (const Status status = makeRenderer(); !status)
    {
        notice_ = status.error().message;
        settings_ = settings;
        options_.mode = mode;
        check(bool(makeRenderer()), "what was there a moment ago fits no longer");
    }
}

/// Renders and shows one frame; an image is acquired.
void WindowedPlayer::showFrame(Statistics& statistics)
{
    Recorder& rec = flights_[turn_].rec;
    rec.timeScopes(panel_ || !options_.stats.empty());
    rec.begin(opened_.scene->descriptorSet());
    {
        const auto scope = rec.scope("frame");
        showMoment(rec);
        renderer_->record(rec, fly_.camera(), settings_, options_.seed, renderer_->maxBatch());
        const Buffer& pixels = renderer_->display(rec, settings_, swapchain_.bgra());
        const auto shown = rec.scope("show");
        const VkCommandBuffer commands = rec.commands();
        swapchain_.beginOverlay(commands, pixels);
        overlay_.draw(commands);
        swapchain_.endOverlay(commands);
    }
    if (statistics.first_submit_ms == 0)
        statistics.noteFirstSubmit(*opened_.device);
    rec.submit(swapchain_.acquired(), swapchain_.rendered());
    flights_[turn_].submitted = true;
    swapchain_.present();
    turn_ = (turn_ + 1) % kFramesInFlight;
}

/// Waits for a frame, and takes its times.
void WindowedPlayer::land(Flight& flight, Statistics& statistics)
{
    if (!std::exchange(flight.submitted, false))
        return;
    stages_ = flight.rec.wait();
    statistics.addFrame(stages_);
}

bool WindowedPlayer::finished(uint32_t frames) const
{
    return window_.closing() || swapchain_.lost() || (options_.frame_count > 0 && frames >= options_.frame_count) ||
           (options_.sample_count > 0 && renderer_ && renderer_->sampleCount() >= options_.sample_count);
}

Status WindowedPlayer::play(Statistics& statistics)
{
    bool drawable = true;
    for (uint32_t frames = 0; !finished(frames);)
    {
        window_.poll(!drawable);
        land(flights_[turn_], statistics);
        drawable = swapchain_.acquire();
        if (!drawable)
        {
            const Result<bool> fits = fitSurface();
            if (!fits)
                return fits.error();
            drawable = *fits;
            continue;
        }
        const auto now = Clock::now();
        const float seconds = std::chrono::duration<float>(now - std::exchange(last_frame_, now)).count();
        frame_ms_ = seconds * 1000.0;
        overlay_.begin();
        useKeys();
        usePanel();
        // A slow frame must not throw the camera across the scene.
        moveCamera(std::min(seconds, 0.25f));
        playback_.advance(seconds, duration());
        showFrame(statistics);
        ++frames;
    }
    if (recorder_)
        toggleRecording();
    for (uint32_t i = 0; i < kFramesInFlight; ++i)
        land(flights_[(turn_ + i) % kFramesInFlight], statistics);
    if (!renderer_) // closed before anything could be seen
        return Success{};
    return writeResults(options_, opened_, *renderer_, settings_, statistics);
}
} // namespace

Status playWindowed(const PlayerOptions& options)
{
    Statistics statistics;
    const auto window =
        Window::open(fmt::format("Lumicut - {}", options.package.filename().string()), options.width, options.height);
    if (!window)
        return window.error();
    const auto opened = openScene(options, (*window)->instanceExtensions(), statistics);
    if (!opened)
        return opened.error();
    const auto swapchain =
        Swapchain::create(opened->instance, *opened->device, (*window)->createSurface(opened->instance));
    if (!swapchain)
        return swapchain.error();
    WindowedPlayer player(options, **window, *opened, **swapchain);
    return player.play(statistics);
}
