/// @file status.h
/// Status codes and the message that goes with them.
///
/// Every fallible function of the library returns a `pls_status`. When it is not `PLS_OK`, `pls_last_message()` tells
/// what happened, where, why and what to do. The message belongs to the calling thread and needs no allocation, so it is
/// there even when memory has run out.
#ifndef PARTICLS_STATUS_H
#define PARTICLS_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

/// The one list of status codes: name, text. The enumeration, `pls_status_text()` and the docs come from it.
#define PLS_STATUS_LIST(X)                                           \
    X(OK, "success")                                                 \
    X(OUT_OF_MEMORY, "out of memory")                                \
    X(INVALID_ARGUMENT, "invalid argument")                          \
    X(NOT_FOUND, "not found")                                        \
    X(DUPLICATE, "already exists")                                   \
    X(LIMIT_EXCEEDED, "a limit of the program is exceeded")          \
    X(STALE_ID, "the id names something that no longer exists")      \
    X(SCENE, "the scene is wrong")                                   \
    X(EXPRESSION, "an expression is wrong")                          \
    X(IO, "input or output failed")                                  \
    X(DISK_FULL, "the disk is full")                                 \
    X(CORRUPT, "a file is damaged")                                  \
    X(VERSION, "a file or plugin is of another version")             \
    X(PLUGIN, "a plugin cannot be used")                             \
    X(UNSTABLE_STEP, "the time step is larger than the stable step") \
    X(NOT_A_NUMBER, "a value is not a number")                       \
    X(LOST_BODY, "a body has left the domain")                       \
    X(RUNAWAY_OVERLAP, "two bodies overlap too deeply")              \
    X(INTERRUPTED, "interrupted")                                    \
    X(USER, "a user function failed")

typedef enum pls_status {
#define PLS_STATUS_ENUM(name, text) PLS_##name,
    PLS_STATUS_LIST(PLS_STATUS_ENUM)
#undef PLS_STATUS_ENUM
        PLS_STATUS_COUNT
} pls_status;

/// Short text of a code, for example "out of memory". Never null.
const char *pls_status_text(pls_status status);

/// Name of a code, for example "OUT_OF_MEMORY". Never null.
const char *pls_status_name(pls_status status);

/// Message of the last failure on this thread, "" if there was none. Valid until the next failure on this thread.
const char *pls_last_message(void);

/// Record a failure and return its code, for user functions: `return pls_fail(PLS_USER, "my law: kn is %g", kn);`
/// The text is cut at 2,000 characters.
pls_status pls_fail(pls_status status, const char *format, ...) __attribute__((format(printf, 2, 3)));

/// Put words in front of the recorded message ("while reading x.csv: " + message); returns `status`.
pls_status pls_fail_context(pls_status status, const char *format, ...) __attribute__((format(printf, 2, 3)));

/// Return early when a call fails.
#define PLS_TRY(call)                                          \
    do {                                                       \
        pls_status pls_try_status_ = (call);                   \
        if (pls_try_status_ != PLS_OK) return pls_try_status_; \
    } while (0)

#ifdef __cplusplus
}
#endif
#endif
