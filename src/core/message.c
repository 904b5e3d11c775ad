/* The text of the last failure on a context. Calls on a const context may fail in several threads at once: the flag lets one
 * of them write. Where the compiler has no atomic operations two may write at once, and the text is a mixture, which ends all the
 * same. */
#include <stdarg.h>
#include <stdio.h>

#include "context.h"

struct message {
    char busy;
    char text[240];
};

#if defined(TRIBO_GNU_C)
#define TAKE(flag) (!__atomic_test_and_set(&(flag), __ATOMIC_ACQUIRE))
#define RELEASE(flag) __atomic_clear(&(flag), __ATOMIC_RELEASE)
#else
#define TAKE(flag) ((flag) ? 0 : ((flag) = 1))
#define RELEASE(flag) ((flag) = 0)
#endif

size_t tribo_message_size(void)
{
    return sizeof(struct message);
}

int tribo_fail(const tribo_context *ctx, int status, const char *format, ...)
{
    struct message *m = ctx->message;
    if (TAKE(m->busy)) {
        va_list args;
        va_start(args, format);
        vsnprintf(m->text, sizeof m->text, format, args);
        va_end(args);
        RELEASE(m->busy);
    }
    return status;
}

int tribo_set_message(const tribo_context *ctx, int status, const char *text)
{
    return ctx && text && text != ctx->message->text ? tribo_fail(ctx, status, "%s", text) : status;
}

const char *tribo_message(const tribo_context *ctx)
{
    return ctx ? ctx->message->text : "ctx is NULL";
}
