/* A disk that fails, by LD_PRELOAD: counts the calls that write below one folder, and lets them fail from a number on.

   The file named by DISK_FAULTS is mapped by every process (Python, SQLite inside it, git): who started them sets there
   which call fails and how, and reads how many there were. Paths are taken as the kernel knows them, so links count. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

struct control {
    long count;   /* calls so far */
    long at;      /* the first that fails, from 1; 0: none */
    long last;    /* the last that fails */
    long fault;   /* errno; 0: the process is killed */
    long refused; /* calls that failed */
    long stuck;   /* of those, the ones that were to take a file away */
    char root[PATH_MAX];
    char first[PATH_MAX]; /* call and path that failed first */
};

static struct control *control;

__attribute__((constructor)) static void map_control(void) {
    const char *name = getenv("DISK_FAULTS");
    int file = name ? open(name, O_RDWR | O_CLOEXEC) : -1;
    if (file < 0) return;
    void *found = mmap(NULL, sizeof(struct control), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (found != MAP_FAILED) control = found;
    close(file);
}

static int below(const char *path) {
    size_t length = strlen(control->root);
    return length && strncmp(path, control->root, length) == 0 && (path[length] == '/' || path[length] == 0);
}

/* Put the absolute path of a name into `out`: its folder as the kernel knows it, and the last part as it is. */
static int absolute(int folder, const char *name, char *out) {
    char whole[PATH_MAX], parent[PATH_MAX], link[64];
    if (name[0] == '/') {
        if (snprintf(whole, sizeof whole, "%s", name) >= (int)sizeof whole) return 0;
    } else {
        char base[PATH_MAX];
        if (folder == AT_FDCWD) {
            if (!getcwd(base, sizeof base)) return 0;
        } else {
            snprintf(link, sizeof link, "/proc/self/fd/%d", folder);
            ssize_t length = readlink(link, base, sizeof base - 1);
            if (length < 0) return 0;
            base[length] = 0;
        }
        if (snprintf(whole, sizeof whole, "%s/%s", base, name) >= (int)sizeof whole) return 0;
    }
    char *slash = strrchr(whole, '/');
    const char *leaf = slash + 1;
    snprintf(parent, sizeof parent, "%.*s", (int)(slash - whole), whole);
    char real[PATH_MAX];
    if (!realpath(parent[0] ? parent : "/", real)) return snprintf(out, PATH_MAX, "%s", whole) < PATH_MAX;
    return snprintf(out, PATH_MAX, "%s/%s", real, leaf) < PATH_MAX;
}

static int path_of(int file, char *out) {
    char link[64];
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    ssize_t length = readlink(link, out, PATH_MAX - 1);
    if (length < 0) return 0;
    out[length] = 0;
    return 1;
}

/* Whether this call, the next one that is counted, is to fail; `takes` for one that takes a file away. */
static int fails(const char *call, const char *path, int takes) {
    if (takes && control->fault == ENOSPC) return 0; /* a full disk lets go of files */
    long number = __atomic_add_fetch(&control->count, 1, __ATOMIC_SEQ_CST);
    if (!control->at || number < control->at || number > control->last) return 0;
    if (__atomic_fetch_add(&control->refused, 1, __ATOMIC_SEQ_CST) == 0)
        snprintf(control->first, sizeof control->first, "%s %.4000s", call, path);
    if (takes) __atomic_fetch_add(&control->stuck, 1, __ATOMIC_SEQ_CST);
    if (!control->fault) raise(SIGKILL);
    return 1;
}

static int refuse_at(const char *call, int folder, const char *name, int takes) {
    char path[PATH_MAX];
    int before = errno;
    int yes = control && name && absolute(folder, name, path) && below(path) && fails(call, path, takes);
    errno = yes ? (int)control->fault : before;
    return yes;
}

static int refuse(const char *call, int file) {
    char path[PATH_MAX];
    int before = errno;
    int yes = control && path_of(file, path) && below(path) && fails(call, path, 0);
    errno = yes ? (int)control->fault : before;
    return yes;
}

static int refuse_open(int folder, const char *name, int flags) {
    char path[PATH_MAX];
    struct stat found;
    int before = errno, yes = 0;
    if (control && name && (flags & (O_CREAT | O_TRUNC | O_WRONLY | O_RDWR)) && absolute(folder, name, path) && below(path)) {
        int exists = fstatat(AT_FDCWD, path, &found, 0) == 0;
        int makes = (flags & O_CREAT) && !exists;
        int refused = (flags & O_CREAT) && (flags & O_EXCL) && exists; /* fails anyway, and is no write */
        if (!refused && (exists || makes) && (makes || control->fault == EROFS)) yes = fails("open", path, 0);
    }
    errno = yes ? (int)control->fault : before;
    return yes;
}

#define REAL(type, name, ...) \
    static type (*real)(__VA_ARGS__); \
    if (!real) real = (type(*)(__VA_ARGS__))dlsym(RTLD_NEXT, name)

#define OPEN(symbol) \
    int symbol(const char *name, int flags, ...) { \
        REAL(int, #symbol, const char *, int, ...); \
        va_list more; va_start(more, flags); int mode = va_arg(more, int); va_end(more); \
        return refuse_open(AT_FDCWD, name, flags) ? -1 : real(name, flags, mode); \
    }
OPEN(open)
OPEN(open64)

#define OPENAT(symbol) \
    int symbol(int folder, const char *name, int flags, ...) { \
        REAL(int, #symbol, int, const char *, int, ...); \
        va_list more; va_start(more, flags); int mode = va_arg(more, int); va_end(more); \
        return refuse_open(folder, name, flags) ? -1 : real(folder, name, flags, mode); \
    }
OPENAT(openat)
OPENAT(openat64)

#define CREAT(symbol) \
    int symbol(const char *name, mode_t mode) { \
        REAL(int, #symbol, const char *, mode_t); \
        return refuse_open(AT_FDCWD, name, O_CREAT | O_WRONLY | O_TRUNC) ? -1 : real(name, mode); \
    }
CREAT(creat)
CREAT(creat64)

#define FOPEN(symbol) \
    FILE *symbol(const char *name, const char *mode) { \
        REAL(FILE *, #symbol, const char *, const char *); \
        int flags = mode[0] == 'r' ? (strchr(mode, '+') ? O_RDWR : 0) : O_CREAT | O_WRONLY; \
        return refuse_open(AT_FDCWD, name, flags) ? NULL : real(name, mode); \
    }
FOPEN(fopen)
FOPEN(fopen64)

ssize_t write(int file, const void *data, size_t size) {
    REAL(ssize_t, "write", int, const void *, size_t);
    return refuse("write", file) ? -1 : real(file, data, size);
}

ssize_t writev(int file, const struct iovec *data, int count) {
    REAL(ssize_t, "writev", int, const struct iovec *, int);
    return refuse("write", file) ? -1 : real(file, data, count);
}

#define PWRITE(symbol) \
    ssize_t symbol(int file, const void *data, size_t size, off_t at) { \
        REAL(ssize_t, #symbol, int, const void *, size_t, off_t); \
        return refuse("write", file) ? -1 : real(file, data, size, at); \
    }
PWRITE(pwrite)
PWRITE(pwrite64)

#define SEND(symbol) \
    ssize_t symbol(int to, int from, off_t *at, size_t size) { \
        REAL(ssize_t, #symbol, int, int, off_t *, size_t); \
        return refuse("write", to) ? -1 : real(to, from, at, size); \
    }
SEND(sendfile)
SEND(sendfile64)

ssize_t copy_file_range(int from, off64_t *a, int to, off64_t *b, size_t size, unsigned flags) {
    REAL(ssize_t, "copy_file_range", int, off64_t *, int, off64_t *, size_t, unsigned);
    return refuse("write", to) ? -1 : real(from, a, to, b, size, flags);
}

#define ON_FILE(symbol) \
    int symbol(int file) { \
        REAL(int, #symbol, int); \
        return refuse(#symbol, file) ? -1 : real(file); \
    }
ON_FILE(fsync)
ON_FILE(fdatasync)

#define TRUNCATE(symbol) \
    int symbol(int file, off_t size) { \
        REAL(int, #symbol, int, off_t); \
        return refuse("ftruncate", file) ? -1 : real(file, size); \
    }
TRUNCATE(ftruncate)
TRUNCATE(ftruncate64)

#define ALLOCATE(symbol) \
    int symbol(int file, off_t from, off_t size) { \
        REAL(int, #symbol, int, off_t, off_t); \
        return refuse("fallocate", file) ? (int)control->fault : real(file, from, size); \
    }
ALLOCATE(posix_fallocate)
ALLOCATE(posix_fallocate64)

int mkdir(const char *name, mode_t mode) {
    REAL(int, "mkdir", const char *, mode_t);
    struct stat found;
    if (stat(name, &found) == 0) return real(name, mode); /* exists: says so */
    return refuse_at("mkdir", AT_FDCWD, name, 0) ? -1 : real(name, mode);
}

int mkdirat(int folder, const char *name, mode_t mode) {
    REAL(int, "mkdirat", int, const char *, mode_t);
    return refuse_at("mkdir", folder, name, 0) ? -1 : real(folder, name, mode);
}

int rename(const char *from, const char *to) {
    REAL(int, "rename", const char *, const char *);
    return refuse_at("rename", AT_FDCWD, to, 0) ? -1 : real(from, to);
}

int renameat(int a, const char *from, int b, const char *to) {
    REAL(int, "renameat", int, const char *, int, const char *);
    return refuse_at("rename", b, to, 0) ? -1 : real(a, from, b, to);
}

int link(const char *from, const char *to) {
    REAL(int, "link", const char *, const char *);
    return refuse_at("link", AT_FDCWD, to, 0) ? -1 : real(from, to);
}

int linkat(int a, const char *from, int b, const char *to, int flags) {
    REAL(int, "linkat", int, const char *, int, const char *, int);
    return refuse_at("link", b, to, 0) ? -1 : real(a, from, b, to, flags);
}

int symlink(const char *from, const char *to) {
    REAL(int, "symlink", const char *, const char *);
    return refuse_at("symlink", AT_FDCWD, to, 0) ? -1 : real(from, to);
}

#define TAKE(symbol) \
    int symbol(const char *name) { \
        REAL(int, #symbol, const char *); \
        struct stat found; \
        if (lstat(name, &found)) return real(name); \
        return control && control->fault == EROFS && refuse_at(#symbol, AT_FDCWD, name, 1) ? -1 : real(name); \
    }
TAKE(unlink)
TAKE(rmdir)

int unlinkat(int folder, const char *name, int flags) {
    REAL(int, "unlinkat", int, const char *, int);
    struct stat found;
    if (fstatat(folder, name, &found, AT_SYMLINK_NOFOLLOW)) return real(folder, name, flags);
    return control && control->fault == EROFS && refuse_at("unlink", folder, name, 1) ? -1 : real(folder, name, flags);
}

int fchmod(int file, mode_t mode) {
    REAL(int, "fchmod", int, mode_t);
    return control && control->fault == EROFS && refuse("fchmod", file) ? -1 : real(file, mode);
}

int chmod(const char *name, mode_t mode) {
    REAL(int, "chmod", const char *, mode_t);
    return control && control->fault == EROFS && refuse_at("chmod", AT_FDCWD, name, 0) ? -1 : real(name, mode);
}
