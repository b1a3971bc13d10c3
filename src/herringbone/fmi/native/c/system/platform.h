/* What differs between operating systems, and what the host's locale must not change. */
#ifndef PLATFORM_H
#define PLATFORM_H

#include <stdbool.h>
#include <stddef.h>

#include "message.h"

/* Contents of a file, ended by a zero; NULL with a message if it is missing, larger than
   LARGEST_FILE, or no UTF-8 text. A byte order mark is left out. The caller frees it. */
char *platform_read_text(const char *file, Message *message);
#define LARGEST_FILE (16u << 20)

bool platform_is_file(const char *path);
bool platform_is_absolute(const char *path);

/* Path of a "file:" URI, or a copy of what is no URI; NULL if memory is short. */
char *platform_path(const char *location);

/* folder/name, or name alone if it is absolute; NULL if memory is short. */
char *platform_join(const char *folder, const char *name);

/* Read a decimal number with a point, whatever the locale; false if the text is anything else, has
   more than LONGEST_NUMBER characters, or the value is not finite. */
#define LONGEST_NUMBER 400
bool platform_number(const char *text, double *value);

#endif
