/* SPDX-License-Identifier: BSD-3-Clause */
#include "system.h"

#include <stdlib.h>

struct attached {
    const void *key;
    void *data;
    void (*destroy)(void *data);
    struct attached *next;
};

static const struct attached *attached_find(const tribo_system *sys, const void *key)
{
    const struct attached *a = sys ? sys->attached : NULL;
    while (a && a->key != key) {
        a = a->next;
    }
    return a;
}

int tribo_system_attach(tribo_system *sys, const void *key, void *data, void (*destroy)(void *data))
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    if (!key) {
        return tribo_system_fail(sys, TRIBO_ERR_NULL, "key is NULL");
    }
    if (attached_find(sys, key)) {
        return tribo_system_fail(sys, TRIBO_ERR_STATE, "data of this key is attached to the system already");
    }
    struct attached *a = malloc(sizeof *a);
    if (!a) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for data attached to the system");
    }
    *a = (struct attached){key, data, destroy, sys->attached};
    sys->attached = a;
    return TRIBO_OK;
}

void *tribo_system_attached(const tribo_system *sys, const void *key)
{
    const struct attached *a = attached_find(sys, key);
    return a ? a->data : NULL;
}

void tribo_system_detach(tribo_system *sys)
{
    for (struct attached *a = sys->attached, *next; a; a = next) {
        next = a->next;
        if (a->destroy) {
            a->destroy(a->data);
        }
        free(a);
    }
    sys->attached = NULL;
}
