/* SPDX-License-Identifier: BSD-3-Clause */
/* Names of methods and steppers, which may be given in capitals. */
#ifndef TRIBO_NAME_H
#define TRIBO_NAME_H

/* Returns 1 if text is name, in small or capital letters; name has no capitals. */
static inline int tribo_same_name(const char *name, const char *text)
{
    while (*name && *name == (*text >= 'A' && *text <= 'Z' ? *text - 'A' + 'a' : *text)) {
        name++;
        text++;
    }
    return *name == *text;
}

#endif
