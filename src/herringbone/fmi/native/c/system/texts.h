/* The String parameters of an instance, shared with the FMU states that were saved since they were
   last set, so that saving a state copies no text. */
#ifndef TEXTS_H
#define TEXTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    size_t users;
    char *values[]; /* [texts_count] */
} Texts;

/* No values yet, one user; NULL if memory is short. */
Texts *texts_new(void);
/* Put a copy of a value where there is none; false if memory is short. */
bool texts_put(Texts *texts, uint32_t index, const char *value);
/* The start values, with one user; NULL if memory is short. */
Texts *texts_start(void);
Texts *texts_share(Texts *texts);
void texts_release(Texts *texts);

/* Change one value, in a copy if there are other users; NULL, and nothing changed, if memory is
   short. */
Texts *texts_with(Texts *texts, uint32_t index, const char *value);

#endif
