/* The String parameters of an instance, shared with the FMU states that were saved since they were
   last set, so that saving a state copies no text. */
#ifndef TEXTS_H
#define TEXTS_H

#include <stddef.h>

typedef struct {
    size_t users;
    char *values[]; /* [texts_count] */
} Texts;

/* A copy of these values, with one user; NULL if memory is short. */
Texts *texts_new(const char *const values[]);
Texts *texts_start(void);
Texts *texts_share(Texts *texts);
void texts_release(Texts *texts);

/* Change one value, in a copy if there are other users; NULL, and nothing changed, if memory is
   short. */
Texts *texts_with(Texts *texts, size_t index, const char *value);

#endif
