/* SPDX-License-Identifier: BSD-3-Clause */
/* Version, texts of status codes, and the text of the last failure on a context. Calls on a const context, which threads may
 * share, keep none. */
#include <stdarg.h>
#include <stdio.h>

#include "context.h"

#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)

int tribo_version(void)
{
    return TRIBO_VERSION;
}

const char *tribo_version_string(void)
{
    return TEXT(TRIBO_VERSION_MAJOR) "." TEXT(TRIBO_VERSION_MINOR) "." TEXT(TRIBO_VERSION_PATCH);
}

const char *tribo_strerror(int status)
{
    static const char *const text[] = {
        [TRIBO_OK] = "success",
        [TRIBO_ERR_NULL] = "a required argument is NULL",
        [TRIBO_ERR_NOT_FINITE] = "a value is NaN or infinite",
        [TRIBO_ERR_NEGATIVE] = "a value is negative",
        [TRIBO_ERR_NOT_POSITIVE] = "a value is not positive",
        [TRIBO_ERR_RANGE] = "an index or a choice is out of range",
        [TRIBO_ERR_SIZE] = "sizes do not fit each other, or are too large",
        [TRIBO_ERR_NAME] = "unknown name",
        [TRIBO_ERR_STATE] = "another call must come first",
        [TRIBO_ERR_UNSUPPORTED] = "not available here",
        [TRIBO_ERR_MEMORY] = "out of memory",
        [TRIBO_ERR_NOT_SYMMETRIC] = "a matrix is not symmetric",
        [TRIBO_ERR_INDEFINITE] = "a matrix is not positive (semi)definite",
        [TRIBO_ERR_DUPLICATE] = "an entry is given twice",
        [TRIBO_ERR_INCONSISTENT] = "no balancing force exists in the partition coupling; the least-squares one was returned",
        [TRIBO_ERR_NO_CONVERGENCE] = "a solver did not converge",
        [TRIBO_ERR_STOPPED] = "the observer ended the run",
        [TRIBO_ERR_STEP] = "the step size became too small",
        [TRIBO_ERR_CALLBACK] = "a function of the caller's failed",
        [TRIBO_ERR_CHATTER] = "too many events in too short a time: \"central/fixed\" and \"moreau/fixed\" step over them",
    };
    const int known = status >= 0 && (size_t)status < sizeof text / sizeof *text && text[status];
    return known ? text[status] : "not a tribo status";
}

int tribo_fail(tribo_context *ctx, int status, const char *format, ...)
{
    if (ctx) {
        va_list args;
        va_start(args, format);
        vsnprintf(ctx->message, sizeof ctx->message, format, args);
        va_end(args);
    }
    return status;
}

const char *tribo_message(const tribo_context *ctx)
{
    return ctx ? ctx->message : "ctx is NULL";
}
