/* Loaded before the C library (LD_PRELOAD): a disk that is full from the n-th write on, and a clock that goes back.

   ROBUSTNESS_FULL=n    every call from the n-th on that makes a regular file or directory grow fails with ENOSPC
   ROBUSTNESS_COUNT=f   how many such calls there were is written to the file f when the process ends
   ROBUSTNESS_BACK=s    each look at the clock finds it s seconds further back
*/
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

static long calls, looks;

static long setting(const char *name) {
    const char *text = getenv(name);
    return text ? atol(text) : 0;
}

static int full(void) {
    long from = setting("ROBUSTNESS_FULL"), now = __sync_add_and_fetch(&calls, 1);
    if (from && now >= from) {
        errno = ENOSPC;
        return 1;
    }
    return 0;
}

static int regular(int fd) {
    struct stat status;
    return fd > 2 && fstat(fd, &status) == 0 && S_ISREG(status.st_mode); /* what is told is no work */
}

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

ssize_t write(int fd, const void *data, size_t size) {
    return regular(fd) && full() ? -1 : NEXT(write)(fd, data, size);
}

ssize_t writev(int fd, const struct iovec *parts, int count) {
    return regular(fd) && full() ? -1 : NEXT(writev)(fd, parts, count);
}

ssize_t pwrite64(int fd, const void *data, size_t size, off64_t at) {
    return regular(fd) && full() ? -1 : NEXT(pwrite64)(fd, data, size, at);
}

int mkdir(const char *path, mode_t mode) { return full() ? -1 : NEXT(mkdir)(path, mode); }

static int creates(const char *path, int flags) {
    struct stat status;
    return (flags & O_CREAT) && stat(path, &status) != 0;
}

int open64(const char *path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    mode_t mode = va_arg(rest, int);
    va_end(rest);
    return creates(path, flags) && full() ? -1 : NEXT(open64)(path, flags, mode);
}

int open(const char *path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    mode_t mode = va_arg(rest, int);
    va_end(rest);
    return creates(path, flags) && full() ? -1 : NEXT(open)(path, flags, mode);
}

static time_t shift(void) { return setting("ROBUSTNESS_BACK") * __sync_add_and_fetch(&looks, 1); }

int clock_gettime(clockid_t clock, struct timespec *now) {
    int result = NEXT(clock_gettime)(clock, now);
    if (result == 0 && clock == CLOCK_REALTIME) now->tv_sec -= shift();
    return result;
}

time_t time(time_t *result) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    if (result) *result = now.tv_sec;
    return now.tv_sec;
}

int gettimeofday(struct timeval *result, void *zone) {
    struct timespec now;
    (void)zone;
    clock_gettime(CLOCK_REALTIME, &now);
    result->tv_sec = now.tv_sec;
    result->tv_usec = now.tv_nsec / 1000;
    return 0;
}

__attribute__((destructor)) static void tell(void) {
    const char *path = getenv("ROBUSTNESS_COUNT");
    FILE *file = path ? fopen(path, "a") : NULL;
    if (file) {
        fprintf(file, "%ld\n", calls);
        fclose(file);
    }
}
