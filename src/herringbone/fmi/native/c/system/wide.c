/* Whether kernels may use vectors of 256 bits, for processors of the x86-64 family, where somebody
   tests it; see fmi/native/wide.py. */
#if defined(__x86_64__) && !defined(__APPLE__)
#include <cpuid.h>
#include <stdint.h>

enum { SAVES_STATE = 1 << 27, HAS_AVX = 1 << 28, BOTH_HALVES = 6 };

/* Read by the kernels. */
uint8_t hb_wide;

/* When the library is loaded, before any instance. Intel 64 and IA-32 Architectures Software
   Developer's Manual, volume 1, section 14.3: the processor has the vectors, and the system saves
   them. */
#if defined _WIN32
void find_wide(void) { /* by the entry point: nothing else calls constructors there */
#else
__attribute__((constructor)) static void find_wide(void) {
#endif
    unsigned a, b, c, d, low, high;
    if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & SAVES_STATE) || !(c & HAS_AVX))
        return;
    __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    hb_wide = (low & BOTH_HALVES) == BOTH_HALVES;
}
#endif
