/* Lets one call of the C library fail, the n-th of its kind; loaded before it (LD_PRELOAD).

   What lies in /proc, /sys and /dev, and what is no file, never fails. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

enum { NONE, ALLOCATE, OPEN, WRITE, CHANGE };

static int kind = NONE, with = 0;
static long calls = 0, failing = -1;

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);

/* From now on count calls of a kind; the n-th, from 1, fails with this number of an error. */
void fail_at(int what, long n, int error) { kind = what, failing = n, with = error, calls = 0; }
long counted(void) { return calls; }

static int fails(int what) {
    if (what != kind) return 0;
    ++calls;
    if (calls != failing) return 0;
    errno = with;
    return 1;
}
static int ours(const char *path) {
    return path && strncmp(path, "/proc", 5) && strncmp(path, "/sys", 4) && strncmp(path, "/dev", 4);
}
static int is_file(int descriptor) {
    struct stat found;
    int before = errno, file = !fstat(descriptor, &found) && S_ISREG(found.st_mode);
    errno = before;
    return file;
}

void *malloc(size_t size) { return fails(ALLOCATE) ? NULL : __libc_malloc(size); }
void *calloc(size_t count, size_t size) { return fails(ALLOCATE) ? NULL : __libc_calloc(count, size); }
void *realloc(void *old, size_t size) { return fails(ALLOCATE) ? NULL : __libc_realloc(old, size); }

#define MODE(flags) \
    mode_t mode = 0; \
    if (flags & (O_CREAT | O_TMPFILE)) { \
        va_list rest; \
        va_start(rest, flags); \
        mode = va_arg(rest, mode_t); \
        va_end(rest); \
    }
#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
#define OPENS(name) \
    int name(const char *path, int flags, ...) { \
        MODE(flags) \
        return ours(path) && fails(OPEN) ? -1 : REAL(name)(path, flags, mode); \
    }
OPENS(open)
OPENS(open64)
#define OPENS_AT(name) \
    int name(int folder, const char *path, int flags, ...) { \
        MODE(flags) \
        return ours(path) && fails(OPEN) ? -1 : REAL(name)(folder, path, flags, mode); \
    }
OPENS_AT(openat)
OPENS_AT(openat64)
FILE *fopen(const char *path, const char *how) {
    return ours(path) && fails(OPEN) ? NULL : REAL(fopen)(path, how);
}
FILE *fopen64(const char *path, const char *how) {
    return ours(path) && fails(OPEN) ? NULL : REAL(fopen64)(path, how);
}
ssize_t write(int descriptor, const void *content, size_t size) {
    if (kind == WRITE && is_file(descriptor) && fails(WRITE)) return -1;
    return REAL(write)(descriptor, content, size);
}
int fsync(int descriptor) { return fails(CHANGE) ? -1 : REAL(fsync)(descriptor); }
int ftruncate64(int descriptor, off64_t size) {
    return fails(CHANGE) ? -1 : REAL(ftruncate64)(descriptor, size);
}
int rename(const char *from, const char *to) { return fails(CHANGE) ? -1 : REAL(rename)(from, to); }
int unlink(const char *path) { return fails(CHANGE) ? -1 : REAL(unlink)(path); }
int mkdir(const char *path, mode_t mode) { return fails(CHANGE) ? -1 : REAL(mkdir)(path, mode); }
