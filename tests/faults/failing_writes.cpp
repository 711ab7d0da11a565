// Loaded before the C library (LD_PRELOAD): the k-th write to a file whose path holds FAULT_PATH fails, or
// ends the process as a power cut would. Counted are writes, syncs, renames and changes of length.
// FAULT_KIND: "full" (no space is left, from then on), "kill" (SIGKILL) or "count" (nothing; the number goes
// to FAULT_COUNT.<pid>).
#include <dlfcn.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

std::atomic<long> calls{0};

const char* setting(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

std::string path_of(int descriptor) {
    char path[4096];
    const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
    const ssize_t length = ::readlink(link.c_str(), path, sizeof path);
    return length > 0 ? std::string(path, static_cast<std::size_t>(length)) : std::string();
}

/// True if this call shall fail.
bool fails(const std::string& path) {
    const std::string wanted = setting("FAULT_PATH"), kind = setting("FAULT_KIND");
    if (wanted.empty() || path.find(wanted) == std::string::npos) return false;
    const long call = ++calls, at = std::atol(setting("FAULT_AT"));
    if (kind == "kill" && call == at) ::kill(::getpid(), SIGKILL);
    if (kind != "full" || call < at) return false;
    errno = ENOSPC;
    return true;
}

template <class Function>
Function next(const char* name) {
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

struct Counted {
    ~Counted() {
        if (std::string(setting("FAULT_KIND")) != "count") return;
        const std::string file = setting("FAULT_COUNT") + ("." + std::to_string(::getpid()));
        if (std::FILE* out = std::fopen(file.c_str(), "w")) {
            std::fprintf(out, "%ld\n", calls.load());
            std::fclose(out);
        }
    }
} counted;

}  // namespace

extern "C" {

ssize_t write(int file, const void* data, size_t size) {
    static const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
    return fails(path_of(file)) ? -1 : real(file, data, size);
}
ssize_t pwrite(int file, const void* data, size_t size, off_t offset) {
    static const auto real = next<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite");
    return fails(path_of(file)) ? -1 : real(file, data, size, offset);
}
ssize_t pwrite64(int file, const void* data, size_t size, off64_t offset) {
    static const auto real = next<ssize_t (*)(int, const void*, size_t, off64_t)>("pwrite64");
    return fails(path_of(file)) ? -1 : real(file, data, size, offset);
}
ssize_t writev(int file, const iovec* data, int count) {
    static const auto real = next<ssize_t (*)(int, const iovec*, int)>("writev");
    return fails(path_of(file)) ? -1 : real(file, data, count);
}
ssize_t pwritev(int file, const iovec* data, int count, off_t offset) {
    static const auto real = next<ssize_t (*)(int, const iovec*, int, off_t)>("pwritev");
    return fails(path_of(file)) ? -1 : real(file, data, count, offset);
}
int fsync(int file) {
    static const auto real = next<int (*)(int)>("fsync");
    return fails(path_of(file)) ? -1 : real(file);
}
int ftruncate(int file, off_t length) noexcept {
    static const auto real = next<int (*)(int, off_t)>("ftruncate");
    return fails(path_of(file)) ? -1 : real(file, length);
}
int ftruncate64(int file, off64_t length) noexcept {
    static const auto real = next<int (*)(int, off64_t)>("ftruncate64");
    return fails(path_of(file)) ? -1 : real(file, length);
}
int rename(const char* from, const char* to) noexcept {
    static const auto real = next<int (*)(const char*, const char*)>("rename");
    return fails(to) ? -1 : real(from, to);
}
}
