// Records GPU work and submits it. Its order comes from what each kernel declares readonly and writeonly.
#pragma once
#include "runtime/gpu/command_trace.h"
#include "runtime/gpu/device.h"
#include "runtime/gpu/schedule.h"

#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// Frames that may be in flight at a time: before it records one, a caller waits for the frame that many before.
constexpr uint32_t kFramesInFlight = 2;

struct Binding
{
    std::string_view block; // the GLSL block name
    const Buffer& buffer;
};

/// Descriptor set 0 of every kernel, and the buffers in it by binding. Owns neither; images are never written.
struct SceneSet
{
    VkDescriptorSet set = VK_NULL_HANDLE;
    std::span<const Buffer* const> buffers = {};
};

/// What one named scope cost on the GPU.
struct StageTime
{
    std::string name;
    double ms = 0;
};

/// For kernels without push constants.
struct NoParams
{
};

/// Commands run in the order in which they are recorded, as far as their results can tell: where none needs another's, they run side by
/// side, and barriers are placed between steps of such commands (schedule.h). While stages are timed or commands traced they run as recorded.
class Recorder
{
public:
    explicit Recorder(const Device& device);
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    /// Ends a named region when it goes out of scope, timed by timeScopes(). Scopes of one name in one submission add up.
    class Scope
    {
    public:
        explicit Scope(Recorder& recorder) : recorder_(recorder) {}
        ~Scope() { recorder_.endScope(); }
        Scope(const Scope&) = delete;

    private:
        Recorder& recorder_;
    };

    /// Starts a command buffer; every kernel sees `scene` as descriptor set 0. Kernels that read none can do without.
    void begin(const SceneSet& scene = {});
    [[nodiscard]] Scope scope(std::string_view name);
    /// The innermost scope that is open, "" outside of any.
    std::string_view scopeName() const
    {
        return open_scopes_.empty() ? std::string_view() : scopes_[open_scopes_.back()].name;
    }

    void clear(const Buffer& buffer) { fill(buffer, 0); }
    void fill(const Buffer& buffer, uint32_t word);
    void copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t to_offset = 0);
    /// Writes a multiple of 4 bytes from the CPU; what is recorded afterwards sees it. `bytes` may change right after the call.
    void write(const Buffer& to, uint64_t offset, std::span<const std::byte> bytes);

    /// Runs `kernel` on at least `thread_count` threads. `params` must match the kernel's push constants in size, and
    /// `bindings` must name each of its blocks exactly once; either mistake aborts and names the culprit.
    template <typename Params>
    void run(const Kernel& kernel, uint32_t thread_count, const Params& params, std::initializer_list<Binding> bindings)
    {
        prepare(kernel, &params, paramBytes<Params>(), bindings, nullptr);
        dispatch(kernel, thread_count);
    }

    /// The same with at least size.count threads. @param size gpu::QueueSize, which has groups of the kernel's size or aborts
    template <typename Params>
    void runIndirect(const Kernel& kernel, const Buffer& size, const Params& params,
                     std::initializer_list<Binding> bindings)
    {
        prepare(kernel, &params, paramBytes<Params>(), bindings, &size);
        dispatchIndirect(kernel, size);
    }

    /// Makes all writes so far visible to the CPU, submits and waits.
    /// @return the time of each scope, in order of first appearance; without timeScopes() one, "frame", from begin to end
    std::vector<StageTime> submitAndWait();

    /// Whether scopes are timed from the next begin() on. Commands of different scopes then do not overlap, which takes longer.
    void timeScopes(bool timed) { times_scopes_ = timed; }
    /// Notes every command from the next begin() on; null ends that. Scopes are timed, too.
    void traceInto(CommandTrace* trace) { trace_ = trace; }

    /// Barriers since begin(), that of begin() included; steps that are still to be recorded have none yet.
    uint32_t barrierCount() const { return barrier_count_; }
    /// The command buffer, for the swapchain and the user interface: what was recorded before lies in it, and a barrier. Not in a render pass.
    VkCommandBuffer commands();
    /// Ends recording and submits with semaphores (either may be null); wait() then waits and returns the times.
    void submit(VkSemaphore wait_for, VkSemaphore signal);
    std::vector<StageTime> wait();

private:
    template <typename Params>
    static constexpr size_t paramBytes()
    {
        return std::is_empty_v<Params> ? 0 : sizeof(Params);
    }
    struct BoundBuffer
    {
        uint32_t binding;
        VkDescriptorType type;
        VkBuffer buffer;
        VkBufferView texels;
    };
    struct Command // a dispatch where there is a pipeline; else an update with bytes, a copy between buffers, or a fill
    {
        uint32_t step = 0;
        VkPipeline pipeline = VK_NULL_HANDLE;
        VkPipelineLayout layout = VK_NULL_HANDLE;
        uint32_t first_buffer = 0, buffer_count = 0; // in bound_
        uint32_t first_byte = 0, byte_count = 0;     // in bytes_: push constants, or what is written
        VkBuffer from = VK_NULL_HANDLE,
                 to = VK_NULL_HANDLE; // `from` of a dispatch: its group counts, else `groups` are known
        uint64_t from_offset = 0, to_offset = 0, size = 0;
        uint32_t groups = 0, word = 0;
    };
    void prepare(const Kernel& kernel, const void* params, size_t param_bytes, std::initializer_list<Binding> bindings,
                 const Buffer* arguments);
    void dispatch(const Kernel& kernel, uint32_t thread_count);
    void dispatchIndirect(const Kernel& kernel, const Buffer& size);
    uint32_t addBytes(const void* bytes, size_t count);
    /// Records the command, or keeps it until all of its step are known. accesses_ are its accesses; they are none afterwards.
    /// @param bytes of the buffers that it names, for a trace
    void add(Command command, std::string_view name, uint64_t bytes);
    void emit(const Command& command);
    void emitDispatch(const Command& command);
    /// Records all commands that have been kept, step by step.
    void emitSteps();
    void note(const Buffer& buffer, bool reads, bool writes) { accesses_.push_back({buffer.range(), reads, writes}); }
    void barrier();
    /// Copies to memory that the GPU can copy from. @return where
    std::pair<VkBuffer, uint64_t> stage(std::span<const std::byte> bytes);
    // Around each command, where there is a trace: before its barrier, right before it, right after it.
    void beginTraced();
    void startTraced(std::string_view name, uint64_t bytes);
    void endTraced(const Command& command);
    /// Submits what is recorded so far and waits for it.
    void flush();
    void beginCommands();
    void endScope();
    uint32_t timestamp();

    const Device& device_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    VkQueryPool queries_ = VK_NULL_HANDLE;
    PFN_vkCmdPushDescriptorSetKHR push_descriptors_ = nullptr;
    SceneSet scene_;
    uint32_t barrier_count_ = 0;

    bool times_scopes_ = false;
    bool in_order_ = false; // of this submission: scopes are timed
    Schedule schedule_;
    uint32_t step_ = 0; // that was recorded last
    std::vector<Command> kept_;
    std::vector<BoundBuffer> bound_;
    std::vector<std::byte> bytes_;
    std::vector<Access> accesses_;
    Command prepared_; // dispatch without its groups
    uint64_t prepared_bytes_ = 0;

    // Of writes, until this submission has ended; the next one uses it again.
    std::vector<Buffer> staging_;
    std::vector<uint64_t> staged_; // bytes that are taken of each

    struct ScopeRecord
    {
        std::string name;
        uint32_t first, last;
    };
    std::vector<ScopeRecord> scopes_;
    std::vector<size_t> open_scopes_;
    uint32_t query_count_ = 0;
    CommandTrace* trace_ = nullptr;
    double cpu_begin_ms_ = 0; // of the command that is traced
};
