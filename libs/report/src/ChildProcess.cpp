#include "ChildProcess.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "slamot/report/FigureWriter.h"

extern char** environ;

namespace slamot::report {
namespace {

/// A file descriptor that closes itself, here and in the child (which gets a copy as 0, 1 or 2).
class Descriptor {
  public:
    Descriptor(const std::filesystem::path& file, int flags)
        : fd_(open(file.c_str(), flags | O_CLOEXEC, 0666)) {
        if (fd_ < 0) {
            throw ReportError(fmt::format("cannot {} '{}': {}", flags & O_CREAT ? "write" : "read",
                                          file.string(), std::strerror(errno)));
        }
    }
    ~Descriptor() { close(fd_); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return fd_; }

  private:
    int fd_;
};

std::string contentOf(std::FILE* file) {
    std::string text;
    std::array<char, 4096> buffer;
    std::rewind(file);
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file)) {
        text.append(buffer.data(), count);
    }
    return text;
}

std::vector<std::string> environmentWith(std::map<std::string, std::string> extra_paths) {
    std::vector<std::string> variables;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        std::string text = *variable;
        const auto extra = extra_paths.find(text.substr(0, text.find('=')));
        if (extra != extra_paths.end()) {
            text += ":" + extra->second;
            extra_paths.erase(extra);
        }
        variables.push_back(std::move(text));
    }
    for (const auto& [name, path] : extra_paths) {
        variables.push_back(name + "=" + path);
    }
    return variables;
}

/// The null-ended array of C strings that posix_spawnp takes and does not write to.
std::vector<char*> pointersTo(const std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (const std::string& text : texts) {
        pointers.push_back(const_cast<char*>(text.c_str()));
    }
    pointers.push_back(nullptr);
    return pointers;
}

}  // namespace

ChildResult runChild(const std::vector<std::string>& command, const std::filesystem::path& input,
                     const std::filesystem::path& output,
                     const std::map<std::string, std::string>& extra_paths) {
    const Descriptor in(input, O_RDONLY), out(output, O_WRONLY | O_CREAT | O_TRUNC);
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> errors(std::tmpfile(), &std::fclose);
    if (!errors) {
        throw ReportError(fmt::format("cannot make a temporary file: {}", std::strerror(errno)));
    }
    const std::vector<std::string> environment = environmentWith(extra_paths);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in.get(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out.get(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(errors.get()), STDERR_FILENO);
    pid_t pid = 0;
    const int failure = posix_spawnp(&pid, command.front().c_str(), &actions, nullptr,
                                     pointersTo(command).data(), pointersTo(environment).data());
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) {
        return {};
    }
    int status = 0;
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    return {true, WIFEXITED(status) ? WEXITSTATUS(status) : -1, contentOf(errors.get())};
}

}  // namespace slamot::report
