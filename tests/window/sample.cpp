// SPDX-License-Identifier: MIT
#include "sample.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace window::test {

Sample::Sample(const std::string& display, const std::vector<std::string>& arguments) {
    std::string name = (std::filesystem::temp_directory_path() / "sluice-window-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    const std::string log = (folder_ / "log").string();
    std::vector<std::string> owned{SLUICE_WINDOW};
    owned.insert(owned.end(), arguments.begin(), arguments.end());
    std::vector<char*> words;
    for (std::string& word : owned) {
        words.push_back(word.data());
    }
    words.push_back(nullptr);
    process_ = ::fork();
    if (process_ != 0) {
        return;
    }
    // The child: nothing but what the test has made, and the validation layer over every Vulkan call.
    ::unsetenv("WAYLAND_DISPLAY");
    display.empty() ? ::unsetenv("DISPLAY") : ::setenv("DISPLAY", display.c_str(), 1);
    ::setenv("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation", 1);
    ::setenv("SDL_AUDIODRIVER", "dummy", 1);
    const int to = ::open(log.c_str(), O_CREAT | O_WRONLY | O_APPEND, 0600);
    if (to < 0 || ::chdir(folder_.c_str()) != 0) {
        ::_exit(126);
    }
    ::dup2(to, STDOUT_FILENO);
    ::dup2(to, STDERR_FILENO);
    ::execv(words[0], words.data());
    ::_exit(127);
}

Sample::~Sample() {
    if (!ended()) {
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

std::optional<int> Sample::ended() {
    int status = 0;
    if (!code_ && ::waitpid(process_, &status, WNOHANG) == process_) {
        code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    return code_;
}

std::string Sample::text() const {
    std::ostringstream all;
    all << std::ifstream(folder_ / "log").rdbuf();
    return all.str();
}

}  // namespace window::test
