// Reading a module's record in a child: a module whose start-up code crashes, hangs or throws takes the child with
// it and not the program.
#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <sstream>
#include <vector>

#include "slamot/core/plugin/PluginRecord.h"
#include "slamot/core/plugin/PluginRegistry.h"

namespace slamot {
namespace {

constexpr unsigned probe_seconds = 30;

/// In the child: the record as lines, or "!" and the reason.
std::string readRecord(const std::string& file) {
    void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!module) return std::string("!cannot be loaded: ") + dlerror();
    const auto* record = static_cast<const PluginRecord*>(dlsym(module, plugin_record_symbol));
    if (!record)
        return fmt::format("!is no slamot plugin: symbol '{}' is missing (built with slamot_add_plugin()?)",
                           plugin_record_symbol);
    if (record->interface_major != interface_major || record->interface_minor > interface_minor)
        return fmt::format("!was built for plugin interface {}.{}, this program has {}.{}", record->interface_major,
                           record->interface_minor, interface_major, interface_minor);
    const auto differs = [](const char* what, int theirs, int ours) {
        return fmt::format("!was built with {} {:#x}, this program with {:#x}", what, theirs, ours);
    };
    if (record->mrpt_version != MRPT_VERSION) return differs("MRPT", record->mrpt_version, MRPT_VERSION);
    if (record->eigen_max_align_bytes != EIGEN_MAX_ALIGN_BYTES)
        return differs("Eigen alignment", record->eigen_max_align_bytes, EIGEN_MAX_ALIGN_BYTES);
    if (record->compiler_abi != __GXX_ABI_VERSION) return differs("compiler ABI", record->compiler_abi, __GXX_ABI_VERSION);
    return fmt::format("{}\n{}\n{}\n{}\n", record->name, record->class_name, record->kind, record->about);
}

[[noreturn]] void runChild(const std::string& file, int out) {
    // What start-up code prints is noise here; what matters comes through the pipe.
    // By descriptor: closing the streams themselves would write out what the parent has not yet.
    const int nowhere = open("/dev/null", O_WRONLY);
    if (nowhere < 0 || dup2(nowhere, STDOUT_FILENO) < 0 || dup2(nowhere, STDERR_FILENO) < 0) _exit(1);
    alarm(probe_seconds);
    const std::string answer = readRecord(file);
    const auto written = write(out, answer.data(), answer.size());
    _exit(written == static_cast<ssize_t>(answer.size()) ? 0 : 1);
}

std::string readAll(int in) {
    std::string text;
    char buffer[4096];
    for (ssize_t n; (n = read(in, buffer, sizeof buffer)) > 0;) text.append(buffer, static_cast<std::size_t>(n));
    return text;
}

}  // namespace

PluginInfo probePlugin(const std::string& file) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) throw PluginError(file + ": no such plugin file");
    int ends[2];
    if (pipe(ends) != 0) throw PluginError(file + ": cannot be checked: no pipe to a child process");
    const pid_t child = fork();
    if (child < 0) {
        close(ends[0]);
        close(ends[1]);
        throw PluginError(file + ": cannot be checked: no child process");
    }
    if (child == 0) {
        close(ends[0]);
        runChild(file, ends[1]);
    }
    close(ends[1]);
    const std::string answer = readAll(ends[0]);
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);

    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
        throw PluginError(fmt::format("{}: did not finish loading within {} s", file, probe_seconds));
    // Without an answer the module's start-up code has left the program, however politely.
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || answer.empty())
        throw PluginError(file + ": crashed while being loaded");
    if (answer[0] == '!') throw PluginError(fmt::format("{}: {}", file, answer.substr(1)));

    PluginInfo info;
    info.file = std::filesystem::absolute(file).string();
    std::istringstream lines(answer);
    for (std::string* field : {&info.name, &info.class_name, &info.kind, &info.about}) std::getline(lines, *field);
    return info;
}

}  // namespace slamot
