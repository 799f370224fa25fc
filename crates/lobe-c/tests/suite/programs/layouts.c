/* Checks that every layout gives the same bits, that errors are codes, and that threads share a material: layouts FILE. */
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lobe.h"

#undef NDEBUG
#include <assert.h>

enum { COUNT = 20000, MOST = 64 };

static uint32_t state = 1;

static float random_number(void) {
  state = state * 1664525u + 1013904223u;
  return (float)(state >> 8) / 16777216.0f;
}

static void direction(float out[3]) {
  const float x = random_number() - 0.5f, y = random_number() - 0.5f, z = random_number() + 0.01f;
  const float length = sqrtf(x * x + y * y + z * z);
  out[0] = x / length;
  out[1] = y / length;
  out[2] = z / length;
}

static uint64_t hash(const float *values, size_t count) {
  uint64_t hash = 14695981039346656037u;
  for (size_t i = 0; i < count; ++i) {
    uint32_t bits;
    memcpy(&bits, &values[i], sizeof bits);
    hash = (hash ^ bits) * 1099511628211u;
  }
  return hash;
}

static lobe_directions vectors(const float *numbers, size_t stride) {
  const lobe_directions directions = {numbers, numbers + 1, numbers + 2, stride};
  return directions;
}

static float wi[COUNT][3], wo[COUNT][3];

struct job {
  const lobe_material *material;
  uint64_t hash;
};

static void *evaluate(void *argument) {
  struct job *job = argument;
  const size_t channels = lobe_channel_count(job->material);
  float *f = malloc(COUNT * channels * sizeof *f);
  const lobe_values values = {f, channels, 1};
  lobe_error error;
  assert(lobe_eval(job->material, COUNT, vectors(wi[0], 3), vectors(wo[0], 3), values, &error) == LOBE_OK);
  job->hash = hash(f, COUNT * channels);
  free(f);
  return NULL;
}

static void check_layouts(const lobe_material *material, uint64_t expected) {
  const size_t channels = lobe_channel_count(material), count = COUNT * channels;
  lobe_error error;
  float *f = malloc(count * sizeof *f);
  const lobe_values values = {f, channels, 1};

  /* Columns. */
  float *columns = malloc(6 * COUNT * sizeof *columns);
  for (size_t i = 0; i < COUNT; ++i) {
    for (size_t k = 0; k < 3; ++k) {
      columns[k * COUNT + i] = wi[i][k];
      columns[(3 + k) * COUNT + i] = wo[i][k];
    }
  }
  const lobe_directions a = {columns, columns + COUNT, columns + 2 * COUNT, 1};
  const lobe_directions b = {columns + 3 * COUNT, columns + 4 * COUNT, columns + 5 * COUNT, 1};
  assert(lobe_eval(material, COUNT, a, b, values, &error) == LOBE_OK);
  assert(hash(f, count) == expected);
  free(columns);

  /* Four numbers each, and values by channels. */
  float *padded = malloc(4 * COUNT * sizeof *padded);
  for (size_t i = 0; i < COUNT; ++i) memcpy(padded + 4 * i, wi[i], sizeof wi[i]), padded[4 * i + 3] = NAN;
  float *planes = malloc(count * sizeof *planes);
  const lobe_values by_channel = {planes, 1, COUNT};
  assert(lobe_eval(material, COUNT, vectors(padded, 4), vectors(wo[0], 3), by_channel, &error) == LOBE_OK);
  for (size_t i = 0; i < COUNT; ++i) {
    for (size_t c = 0; c < channels; ++c) f[i * channels + c] = planes[c * COUNT + i];
  }
  assert(hash(f, count) == expected);
  free(padded);
  free(planes);

  /* The same light for all, which is read once; numbers between values stay unchanged. */
  float *wide = malloc(COUNT * (channels + 1) * sizeof *wide);
  for (size_t i = 0; i < COUNT * (channels + 1); ++i) wide[i] = 7.0f;
  const lobe_values with_gaps = {wide, channels + 1, 1};
  assert(lobe_eval(material, COUNT, vectors(wi[5], 0), vectors(wo[0], 3), with_gaps, &error) == LOBE_OK);
  for (size_t i = 0; i < 100; ++i) {
    assert(wide[i * (channels + 1) + channels] == 7.0f);
    const lobe_values one = {f, channels, 1};
    assert(lobe_eval(material, 1, vectors(wi[5], 3), vectors(wo[i], 3), one, NULL) == LOBE_OK);
    assert(memcmp(f, wide + i * (channels + 1), channels * sizeof *f) == 0);
  }
  free(wide);
  free(f);
}

static void check_errors(const char *path, const lobe_material *material) {
  lobe_error error;
  lobe_material *none = NULL;
  assert(lobe_open("missing.ddr", NULL, &none, &error) == LOBE_ERROR_FORMAT && none == NULL);
  assert(error.status == LOBE_ERROR_FORMAT && strncmp(error.message, "missing.ddr: ", 13) == 0 && error.line == 0);
  assert(lobe_open(NULL, NULL, &none, &error) == LOBE_ERROR_INVALID && strncmp(error.message, "path: found NULL", 16) == 0);
  assert(lobe_open(path, NULL, NULL, &error) == LOBE_ERROR_INVALID);
  assert(lobe_open(path, NULL, NULL, NULL) == LOBE_ERROR_INVALID);
  assert(lobe_open("\xff\xfe", NULL, &none, &error) == LOBE_ERROR_INVALID);
  lobe_options options = lobe_options_default();
  options.edges = 17;
  assert(lobe_open(path, &options, &none, &error) == LOBE_ERROR_INVALID && strncmp(error.message, "edges: found 17", 15) == 0);
  options = lobe_options_default();
  options.backend = "mmx";
  assert(lobe_open(path, &options, &none, &error) == LOBE_ERROR_INVALID);
  const char *damaged = ";; sigma\n1 2 3\nwhat is this\n";
  assert(lobe_open_bytes((const uint8_t *)damaged, strlen(damaged), "damaged.ddr", NULL, &none, &error) == LOBE_ERROR_FORMAT);
  assert(none == NULL && strstr(error.message, "damaged.ddr") != NULL);
  assert(lobe_open_bytes(NULL, 0, "empty", NULL, &none, &error) == LOBE_ERROR_FORMAT);
  assert(lobe_open_bytes(NULL, 5, "null", NULL, &none, &error) == LOBE_ERROR_INVALID);

  float f[MOST];
  const lobe_values values = {f, lobe_channel_count(material), 1}, nowhere = {NULL, 3, 1}, same = {f, 0, 1};
  const lobe_directions null = {NULL, NULL, NULL, 3};
  assert(lobe_eval(NULL, 1, vectors(wi[0], 3), vectors(wo[0], 3), values, &error) == LOBE_ERROR_INVALID);
  assert(lobe_eval(material, 1, null, vectors(wo[0], 3), values, &error) == LOBE_ERROR_INVALID);
  assert(lobe_eval(material, 1, vectors(wi[0], 3), vectors(wo[0], 3), nowhere, &error) == LOBE_ERROR_INVALID);
  assert(lobe_eval(material, 2, vectors(wi[0], 3), vectors(wo[0], 3), same, &error) == LOBE_ERROR_INVALID);
  assert(lobe_eval(material, 0, null, null, nowhere, &error) == LOBE_OK);
  assert(lobe_eval(material, SIZE_MAX, vectors(wi[0], 3), vectors(wo[0], 3), values, &error) == LOBE_ERROR_INVALID);
  assert(lobe_eval(material, SIZE_MAX / 2, vectors(wi[0], 4), vectors(wo[0], 3), values, &error) == LOBE_ERROR_INVALID);
  double matrix[16];
  assert(lobe_mueller(material, wi[0], wo[0], 550.0, matrix, &error) == LOBE_ERROR_UNSUPPORTED);

  lobe_sampler *sampler = NULL;
  if (strcmp(lobe_kind(material), "specular table") == 0) {
    assert(lobe_sampler_new(material, 0.0f, &sampler, &error) == LOBE_ERROR_INVALID && sampler == NULL);
  }
  assert(lobe_sampler_new(NULL, 0.05f, &sampler, &error) == LOBE_ERROR_INVALID);

  assert(lobe_channel_count(NULL) == 0 && lobe_kind(NULL) == NULL && lobe_material_share(NULL) == NULL);
  assert(lobe_channel_name(material, 1000000) == NULL && lobe_backend_name(1000) == NULL);
  assert(!lobe_holds(material, 5, 5));
  lobe_material_free(NULL);
  lobe_sampler_free(NULL);
}

static void check_sampler(lobe_material *material) {
  lobe_error error;
  lobe_sampler *sampler = NULL;
  assert(lobe_sampler_new(material, 0.05f, &sampler, &error) == LOBE_OK);
  /* A sampler keeps its material alive. */
  lobe_material_free(material);
  enum { DRAWS = 500 };
  float u[DRAWS][2], drawn[DRAWS][3], pdf[DRAWS], again[DRAWS];
  for (int i = 0; i < DRAWS; ++i) u[i][0] = random_number(), u[i][1] = random_number();
  const lobe_values out = {drawn[0], 3, 1}, no_weight = {NULL, 0, 0};
  const lobe_directions light = vectors(wi[0], 0);
  assert(lobe_sample(sampler, LOBE_GIVEN_LIGHT, DRAWS, light, u[0], out, pdf, no_weight, &error) == LOBE_OK);
  assert(lobe_pdf(sampler, LOBE_GIVEN_LIGHT, DRAWS, light, vectors(drawn[0], 3), again, &error) == LOBE_OK);
  for (int i = 0; i < DRAWS; ++i) assert(pdf[i] == 0.0f || fabsf(again[i] / pdf[i] - 1.0f) < 5e-3f);
  u[7][1] = 1.0f;
  assert(lobe_sample(sampler, LOBE_GIVEN_LIGHT, DRAWS, light, u[0], out, pdf, no_weight, &error) == LOBE_ERROR_INVALID);
  assert(lobe_sample(sampler, 3, 0, light, u[0], out, pdf, no_weight, &error) == LOBE_ERROR_INVALID);
  lobe_sampler_free(sampler);
}

int main(int argc, char **argv) {
  assert(argc == 2);
  for (size_t i = 0; i < COUNT; ++i) {
    direction(wi[i]);
    direction(wo[i]);
  }
  lobe_options options = lobe_options_default();
  options.strict = true;
  lobe_error error;
  lobe_material *material = NULL;
  if (lobe_open(argv[1], &options, &material, &error) != LOBE_OK) {
    fprintf(stderr, "%s\n", error.message);
    return 1;
  }
  printf("# %s %s %s %s\n", lobe_version(), lobe_kind(material), lobe_format(material), lobe_channel_name(material, 0));
  assert(lobe_channel_count(material) <= MOST);
  for (size_t i = 0; i < lobe_fact_count(material); ++i) {
    const char *value = NULL;
    assert(lobe_fact(material, i, &value) != NULL && value != NULL && lobe_fact(material, i, NULL) != NULL);
  }

  struct job jobs[3];
  pthread_t threads[3];
  for (int i = 0; i < 3; ++i) {
    jobs[i].material = material;
    assert(pthread_create(&threads[i], NULL, evaluate, &jobs[i]) == 0);
  }
  for (int i = 0; i < 3; ++i) assert(pthread_join(threads[i], NULL) == 0);
  assert(jobs[0].hash == jobs[1].hash && jobs[0].hash == jobs[2].hash);
  check_layouts(material, jobs[0].hash);
  check_errors(argv[1], material);

  /* The bits are the same on the calling thread alone, and on every backend. */
  for (size_t i = 0; i < lobe_backend_count(); ++i) {
    options.serial = i % 2 == 0;
    options.backend = lobe_backend_name(i);
    lobe_material *other = NULL;
    assert(lobe_open(argv[1], &options, &other, &error) == LOBE_OK);
    assert(strcmp(lobe_material_backend(other), options.backend) == 0);
    struct job job = {other, 0};
    evaluate(&job);
    assert(job.hash == jobs[0].hash);
    lobe_material_free(other);
  }
  lobe_material *shared = lobe_material_share(material);
  lobe_material_free(material);
  assert(lobe_material_bytes(shared) > 0);
  printf("%016llx\n", (unsigned long long)jobs[0].hash);
  check_sampler(shared);
  return 0;
}
