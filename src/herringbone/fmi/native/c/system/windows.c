/* What mingw keeps in a C library of its own, as Windows' universal C runtime has it: so none is built
   and linked. Names and numbers are those of mingw's headers (stdio.h, math.h). */
#if defined _WIN32
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <windows.h>

int _fltused; /* compilers name it in whatever has floating-point numbers */

#if defined(__x86_64__)
void find_wide(void); /* wide.c */
#else
static void find_wide(void) {}
#endif

/* All that there is to start up. */
BOOL WINAPI DllMainCRTStartup(HINSTANCE library, DWORD reason, LPVOID reserved) {
    (void)library, (void)reserved;
    if (reason == DLL_PROCESS_ATTACH)
        find_wide();
    return TRUE;
}

int vsnprintf(char *text, size_t size, const char *format, va_list arguments) {
    return __stdio_common_vsprintf(_CRT_INTERNAL_PRINTF_STANDARD_SNPRINTF_BEHAVIOR, text, size,
                                   format, NULL, arguments);
}

int snprintf(char *text, size_t size, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, size, format, arguments);
    va_end(arguments);
    return length;
}

/* Of a value that is not finite: isfinite() asks for no more. */
int __fpclassify(double value) {
    if (value - value == 0.0)
        return FP_NORMAL;
    return value == value ? FP_INFINITE : FP_NAN;
}
#else
typedef int nothing_is_missing_here;
#endif
