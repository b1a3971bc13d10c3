/* What jacobi.c needs of mingw's C library, by Windows' universal C runtime: mingw's own takes a
 * minute to build. Names are those of mingw's headers (stdio.h) and of the runtime's start-up.
 */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

int _configure_narrow_argv(int mode);
int main(int argc, char **argv);

enum { ARGUMENTS_AS_GIVEN = 1 };

void __main(void) {}

void mainCRTStartup(void)
{
    _configure_narrow_argv(ARGUMENTS_AS_GIVEN);
    exit(main(*__p___argc(), *__p___argv()));
}

int fprintf(FILE *file, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = __stdio_common_vfprintf(0, file, format, NULL, arguments);
    va_end(arguments);
    return length;
}

int printf(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = __stdio_common_vfprintf(0, stdout, format, NULL, arguments);
    va_end(arguments);
    return length;
}

int sscanf(const char *text, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int count = __stdio_common_vsscanf(0, text, (size_t)-1, format, NULL, arguments);
    va_end(arguments);
    return count;
}
