// SPDX-License-Identifier: MIT
#include "app/inject.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "app/exit_codes.hpp"
#include "app/log.hpp"
#include "app/output_folders.hpp"
#include "app/plugin_path.hpp"
#include "image/atomic_file.hpp"

namespace sluice::cli {

namespace {

constexpr const char* kShimFile = "libsluice_inject.so";
constexpr const char* kPreload = "LD_PRELOAD";
constexpr const char* kSettings = "SLUICE_INJECT";
constexpr std::size_t kMostSettings = 16000;  // what the shim has room for

Result<std::string> findShim() {
    std::error_code ignored;
    const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
    for (const char* place : {"", "../lib/sluice"}) {
        const std::filesystem::path candidate = (folder / place / kShimFile).lexically_normal();
        if (std::filesystem::exists(candidate, ignored)) {
            if (candidate.string().find_first_of(" :\n") != std::string::npos) {
                return Error{SLUICE_ERROR_INVALID_ARGUMENT, candidate.string(),
                             "LD_PRELOAD cannot name a path with a space or a colon", "install Sluice elsewhere"};
            }
            return candidate.string();
        }
    }
    return Error{
        SLUICE_ERROR_UNSUPPORTED, kShimFile,
        fmt::format("not found in {} and {}", folder.string(), (folder / "../lib/sluice").lexically_normal().string()),
        "install Sluice as a whole"};
}

/// A script's program is a child of its interpreter, or the interpreter's heir: either way it has lost the shim.
void warnOfScript(const InjectOptions& options) {
    std::string path = options.command.front();
    if (path.find('/') == std::string::npos) {
        const char* places = std::getenv("PATH");
        std::string rest = places == nullptr ? "" : places;
        while (!rest.empty()) {
            const std::string folder = rest.substr(0, rest.find(':'));
            rest.erase(0, std::min(folder.size() + 1, rest.size()));
            const std::string candidate = fmt::format("{}/{}", folder, path);
            if (::access(candidate.c_str(), X_OK) == 0) {
                path = candidate;
                break;
            }
        }
    }
    std::array<char, 2> begin{};
    std::ifstream(path, std::ios::binary).read(begin.data(), begin.size());
    if (!options.children && begin[0] == '#' && begin[1] == '!') {
        log(SLUICE_LOG_WARNING,
            fmt::format("{} is a script; add --children if the program that draws is one that it starts", path));
    }
}

void setEnvironment(const inject::Settings& settings) {
    const char* present = std::getenv(kPreload);
    const std::string preload =
        settings.shim + (present == nullptr || *present == '\0' ? "" : std::string(":") + present);
    (void)::setenv(kPreload, preload.c_str(), 1);
    (void)::setenv(kSettings, inject::printSettings(settings).c_str(), 1);
}

[[noreturn]] void start(const InjectOptions& options) {
    std::vector<char*> words;
    for (const std::string& word : options.command) {
        words.push_back(const_cast<char*>(word.c_str()));
    }
    words.push_back(nullptr);
    (void)::execvp(words.front(), words.data());
    const int why = errno;
    (void)fmt::print(stderr, "sluice: {}: cannot be started: {}\n", options.command.front(), std::strerror(why));
    ::_exit(why == ENOENT ? 127 : 126);  // as a shell has it
}

volatile std::sig_atomic_t child_of_signals = 0;

extern "C" void passOn(int signal) {
    if (child_of_signals > 0) {
        (void)::kill(child_of_signals, signal);
    }
}

/// Runs the program as a child, because somebody has to print the report when it has ended, however it did.
int runAndReport(const InjectOptions& options, const std::string& folder) {
    const pid_t child = ::fork();
    if (child < 0) {
        log(SLUICE_LOG_ERROR, fmt::format("fork: {}", std::strerror(errno)));
        return kExitInternal;
    }
    if (child == 0) {
        start(options);
    }
    child_of_signals = child;
    // What a terminal sends goes to both anyhow; what is sent to this process alone was meant for the program.
    struct sigaction pass {};
    pass.sa_handler = passOn;
    for (const int signal : {SIGTERM, SIGHUP, SIGUSR1, SIGUSR2}) {
        (void)::sigaction(signal, &pass, nullptr);
    }
    (void)std::signal(SIGINT, SIG_IGN);
    (void)std::signal(SIGQUIT, SIG_IGN);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    const std::string text = injectReport(folder, options.json);
    if (options.report_to.empty()) {
        fmt::print("{}", text);
        (void)std::fflush(stdout);
    } else if (const Status written = writeTextFile(options.report_to, text); !written) {
        logError(written.error());
    }
    if (WIFSIGNALED(status)) {
        // Ends as the program did, so that a shell sees the same; without a core of its own.
        (void)std::signal(WTERMSIG(status), SIG_DFL);
        const rlimit no_core{0, 0};
        (void)::setrlimit(RLIMIT_CORE, &no_core);
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
        (void)::raise(WTERMSIG(status));
        return 128 + WTERMSIG(status);
    }
    return WEXITSTATUS(status);
}

Result<inject::Settings> settingsOf(const InjectOptions& options) {
    const Result<std::string> shim = findShim();
    if (!shim) {
        return shim.error();
    }
    inject::Settings settings;
    settings.shim = shim.value();
    settings.off = options.off;
    settings.audit = options.report;
    settings.children = options.children;
    settings.same_process = options.same_process;
    settings.step = options.step_s;
    if (!options.plugin.empty()) {
        settings.plugin = std::filesystem::absolute(options.plugin).string();
    }
    if (!options.scene.empty()) {
        if (Status status = readInjectedScene(options.scene, settings); !status) {
            return status.error();
        }
    }
    if (!options.profile.empty()) {
        if (Status status = readProfile(options.profile, settings); !status) {
            return status.error();
        }
    }
    if (inject::printSettings(settings).size() > kMostSettings) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, options.scene, "more boxes of fluid than can be handed over",
                     "leave out some"};
    }
    return settings;
}

}  // namespace

int inject(const InjectOptions& options) {
    Result<inject::Settings> settings = settingsOf(options);
    if (!settings) {
        logError(settings.error());
        return settings.error().code == SLUICE_ERROR_UNSUPPORTED ? kExitNoFluid : kExitBadInput;
    }
    warnOfScript(options);
    OutputFolders outputs;
    if (!options.report_to.empty()) {
        // Known before the program starts, which may run for hours.
        if (Status status = outputs.prepare(options.report_to); !status) {
            logError(status.error());
            return kExitInternal;
        }
    }
    if (!options.report) {
        setEnvironment(settings.value());
        start(options);
    }
    std::string folder = (std::filesystem::temp_directory_path() / "sluice-inject-XXXXXX").string();
    if (::mkdtemp(folder.data()) == nullptr) {
        log(SLUICE_LOG_ERROR, fmt::format("{}: {}", folder, std::strerror(errno)));
        return kExitInternal;
    }
    settings.value().report = folder;
    setEnvironment(settings.value());
    const int code = runAndReport(options, folder);
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    return code;
}

}  // namespace sluice::cli
