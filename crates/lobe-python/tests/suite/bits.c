/* Evaluates materials for pairs of directions: bits PAIRS FILE...
 *
 * PAIRS has all wi, then all wo, as three floats each. The strict values of FILE are written to FILE.c. */
#include <stdio.h>
#include <stdlib.h>

#include "lobe.h"

static void fail(const char *what, const char *why) {
  fprintf(stderr, "%s: %s\n", what, why);
  exit(1);
}

static void write_values(const char *file, const float *pairs, size_t count) {
  lobe_options options = lobe_options_default();
  options.strict = true;
  lobe_material *material = NULL;
  lobe_error error;
  if (lobe_open(file, &options, &material, &error) != LOBE_OK) fail(file, error.message);
  const size_t channels = lobe_channel_count(material);
  float *f = malloc(count * channels * sizeof *f);
  if (!f) fail(file, "no memory");
  const float *viewers = pairs + 3 * count;
  const lobe_directions wi = {pairs, pairs + 1, pairs + 2, 3}, wo = {viewers, viewers + 1, viewers + 2, 3};
  const lobe_values values = {f, channels, 1};
  if (lobe_eval(material, count, wi, wo, values, &error) != LOBE_OK) fail(file, error.message);
  char name[4096];
  snprintf(name, sizeof name, "%s.c", file);
  FILE *out = fopen(name, "wb");
  if (!out || fwrite(f, sizeof *f, count * channels, out) != count * channels || fclose(out)) fail(name, "not written");
  free(f);
  lobe_material_free(material);
}

int main(int argc, char **argv) {
  if (argc < 3) fail("bits", "expected PAIRS FILE...");
  FILE *in = fopen(argv[1], "rb");
  if (!in || fseek(in, 0, SEEK_END)) fail(argv[1], "not read");
  const size_t floats = (size_t)ftell(in) / sizeof(float);
  rewind(in);
  float *pairs = malloc(floats * sizeof *pairs);
  if (!pairs || fread(pairs, sizeof *pairs, floats, in) != floats) fail(argv[1], "not read");
  fclose(in);
  for (int i = 2; i < argc; ++i) write_values(argv[i], pairs, floats / 6);
  free(pairs);
  return 0;
}
