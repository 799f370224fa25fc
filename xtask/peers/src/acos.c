/* Runs the arc cosine of SLEEF on request: `sleef COSINES`, a file of f32. Answers as described in serve.py. */

#include <immintrin.h>
#include <sleef.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { PASSES = 64 };

static float *cosines, *angles;
static long count;

static void run(void) {
    for (int pass = 0; pass < PASSES; pass++)
        for (long at = 0; at < count; at += 8)
            _mm256_storeu_ps(angles + at, Sleef_acosf8_u35avx2(_mm256_loadu_ps(cosines + at)));
}

static double processor_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int main(int argc, char **argv) {
    FILE *file = argc == 2 ? fopen(argv[1], "rb") : NULL;
    if (!file) return 1;
    fseek(file, 0, SEEK_END);
    count = ftell(file) / (long)sizeof(float) / 8 * 8;
    rewind(file);
    cosines = malloc((size_t)count * sizeof(float));
    angles = malloc((size_t)count * sizeof(float));
    if (!cosines || !angles || fread(cosines, sizeof(float), (size_t)count, file) != (size_t)count) return 1;
    fclose(file);
    run();
    printf("ready %d.%d.%d\n", SLEEF_VERSION_MAJOR, SLEEF_VERSION_MINOR, SLEEF_VERSION_PATCHLEVEL);
    fflush(stdout);

    char what[16], path[4096];
    while (scanf("%15s %*s %4095[^\n]", what, path) == 2) {
        if (what[0] == 'r') {
            double least = 1e30;
            for (int times = atoi(path); times > 0; times--) {
                double start = processor_seconds();
                run();
                double seconds = processor_seconds() - start;
                if (seconds < least) least = seconds;
            }
            printf("%.9e\n", least);
        } else {
            FILE *out = fopen(path, "wb");
            if (!out || fwrite(angles, sizeof(float), (size_t)count, out) != (size_t)count || fclose(out)) return 1;
            printf("written\n");
        }
        fflush(stdout);
    }
    return 0;
}
