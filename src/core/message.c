/* The text of the last failure on a context. Calls on a const context, which threads may share, keep none. */
#include <stdarg.h>
#include <stdio.h>

#include "context.h"

struct message {
    char text[240];
};

size_t tribo_message_size(void)
{
    return sizeof(struct message);
}

int tribo_fail(tribo_context *ctx, int status, const char *format, ...)
{
    if (ctx) {
        va_list args;
        va_start(args, format);
        vsnprintf(ctx->message->text, sizeof ctx->message->text, format, args);
        va_end(args);
    }
    return status;
}

const char *tribo_message(const tribo_context *ctx)
{
    return ctx ? ctx->message->text : "ctx is NULL";
}
