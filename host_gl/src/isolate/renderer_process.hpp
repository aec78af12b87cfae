// SPDX-License-Identifier: MIT
// A renderer's process as the host knows it: calls go in, answers or its end come out.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "isolate/child.hpp"
#include "sluice/host_gl/isolation.hpp"
#include "sluice/isolate/channel.hpp"
#include "sluice/isolate/shared_timeline.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::host {

/// What a call may lead to before it ends. NULL: the renderer must not ask for it during this call.
struct CallBacks {
    const SluiceHostServices* services = nullptr;
    SluiceLineSink sink = nullptr;
    void* sink_user = nullptr;
};

/// More callbacks and lines than these during one call, or lines waiting to be read, and the process is ended. A start
/// has a hundred callbacks at most, an explanation thirty lines.
inline constexpr std::uint32_t kMostCallbacks = 4096;
inline constexpr std::uint32_t kMostLines = 1024;

/// What the holder of a renderer that is gone can do.
inline constexpr const char* kRecreate = "destroy the renderer and create it again";

struct Reply {
    isolate::Returned returned;
    std::vector<UniqueFd> fds;
};

/// One process and a thread that starts it and listens to it: log lines and trace events are passed on as they come,
/// the end of the process is noticed whatever anybody waits for. Any thread; calls come one after another.
class RendererProcess {
  public:
    /// `watch` is for tests.
    [[nodiscard]] static Result<std::unique_ptr<RendererProcess>> start(const IsolationConfig& config,
                                                                        const isolate::Hello& hello,
                                                                        ChildWatch watch = {});
    RendererProcess(const RendererProcess&) = delete;
    RendererProcess& operator=(const RendererProcess&) = delete;
    /// Ends it; kills it if it does not end by itself. A process that cannot be killed is left behind after a while.
    ~RendererProcess();

    [[nodiscard]] const isolate::Hello& hello() const { return hello_; }
    [[nodiscard]] const isolate::Welcome& welcome() const { return welcome_; }
    [[nodiscard]] isolate::SharedTimeline& timeline() { return *timeline_; }
    /// False once it has ended.
    [[nodiscard]] bool alive();
    /// Where log lines and trace events go from now on; nullptr: nowhere.
    void passTo(const SluiceHostServices* services);
    /// `doing` is what is said if the process ends meanwhile: "submit_frame of frame 3". Without an answer within the
    /// deadline the process is killed; the time that `back` takes here does not count.
    [[nodiscard]] Result<Reply> call(const isolate::Message& message, std::span<const int> fds, std::string doing,
                                     const CallBacks& back);
    /// The counters are broken, or the renderer's side has failed: nothing it says is of use any more.
    void condemn(std::string blame);
    /// That the process is gone; and how, if the log has not been told. Waits for its end, and a little for a log that
    /// is slow, but not for ever.
    [[nodiscard]] Error gone();
    /// The deadline of calls from now on; not during a call. For tests.
    void limitCalls(std::uint64_t call_timeout_ns);

  private:
    RendererProcess(IsolationConfig config, const isolate::Hello& hello, ChildWatch watch)
        : config_(std::move(config)), hello_(hello), child_(std::move(watch)) {}
    // What the thread does, in renderer_listener.cpp.
    void live(const isolate::Channel& there);
    [[nodiscard]] Status spawn(const isolate::Channel& there);
    void listen();
    void hear(isolate::Received received);
    void noteEnd(const char* misfortune);
    /// And the line that the log gets of it, if any.
    [[nodiscard]] Error endOf(const ChildEnd& ended, const char* misfortune, std::int32_t& level, std::string& line);
    /// False: nobody listens.
    [[nodiscard]] bool log(std::int32_t level, const std::string& text);

    [[nodiscard]] Status spawned();
    [[nodiscard]] Result<isolate::Received> nextMessage(std::uint64_t deadline_ns, std::uint64_t limit_ns);
    /// How long this call may take.
    [[nodiscard]] std::uint64_t limitOf(const isolate::Message& message) const;
    /// Sends it. A process that does not take it is ended; SLUICE_ERROR_DEVICE_LOST says that it is gone.
    [[nodiscard]] Status deliver(const isolate::Message& message, std::uint64_t number, std::span<const int> fds,
                                 const std::string& what, std::uint64_t deadline_ns);
    [[nodiscard]] isolate::Answer answerTo(isolate::Received& asked, const CallBacks& back) const;

    IsolationConfig config_;
    isolate::Hello hello_;
    Child child_;
    isolate::Channel channel_;
    std::unique_ptr<isolate::SharedTimeline> timeline_;
    isolate::Welcome welcome_;
    std::mutex call_mutex_;  ///< a call from its message to its answer
    std::uint64_t calls_ = 0;

    std::mutex services_mutex_;
    std::optional<SluiceHostServices> services_;

    std::mutex mutex_;  ///< of what follows
    std::condition_variable changed_;
    std::optional<Status> spawned_;
    std::deque<isolate::Received> mail_;
    std::uint32_t lines_ = 0;  ///< in mail_; of all else one at most
    bool waiting_ = true;      ///< something was sent that is not answered yet
    std::string doing_ = "its start";
    std::string blame_;         ///< why this process has ended it
    std::optional<Error> end_;  ///< it is gone
    Error last_words_;          ///< for end_ when there is no memory for others
    bool ending_ = false;       ///< it was asked to end
    bool closed_ = false;       ///< it is heard no more
    bool telling_ = false;      ///< the log is being told of the end
    bool told_ = false;         ///< and was
    std::thread listener_;
};

}  // namespace sluice::host
