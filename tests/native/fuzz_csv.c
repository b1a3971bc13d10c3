/* Feeds mutated resource files to the reader: each is read, or refused with one line. */
#include <stdlib.h>
#include <unistd.h>

#include "check.h"
#include "component.h"
#include "flat_csv.h"
#include "mutate.h"

enum { CASES = 8000 };

static void check_case(const char *path, const HbText *grammar, size_t read_counts[2]) {
    Numbers numbers = {NULL, 0};
    int64_t shape[2] = {-1, -1};
    Message message = {""};
    bool read = flat_csv_read(path, grammar, &numbers, shape, &message);
    read_counts[read]++;
    if (read) {
        CHECK(shape[0] > 0 && shape[1] > 0);
        CHECK(numbers.count == grammar->column_count + (size_t)(shape[0] * shape[1]));
        for (size_t i = 0; i < numbers.count; i++)
            CHECK(numbers.values[i] - numbers.values[i] == 0.0);
    } else {
        CHECK(numbers.count == 0 && strstr(message.text, path) && !strchr(message.text, '\n'));
    }
    free(numbers.values);
}

int main(int count, char **arguments) {
    const char *folder = count > 1 ? arguments[1] : ".";
    static char text[LARGEST_SEED];
    char path[4096];
    size_t read_counts[2] = {0, 0};
    snprintf(path, sizeof path, "%s/fuzzed.%d", folder, (int)getpid());
    for (int n = 0; n < CASES; n++) {
        static const char *const seeds[] = {"inertias.csv", "shapes.csv", "excel.csv"};
        char seed[4096];
        snprintf(seed, sizeof seed, "%s/%s", folder, seeds[n % 3]);
        write_mutation(path, text, mutate(text, read_seed(seed, text)));
        check_case(path, &hb_component.texts[n % 3 == 1], read_counts);
    }
    remove(path);
    printf("%zu read, %zu refused\n", read_counts[1], read_counts[0]);
    CHECK(read_counts[1] > CASES / 10 && read_counts[0] > CASES / 10);
    return report();
}
