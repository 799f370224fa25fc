/* Measured BRDFs and BSDFs from C. Made by cbindgen from the crate lobe-c.
 *
 * Directions are unit vectors away from the surface, whose normal is +z: wi points to the light, wo to the viewer. Values are
 * f in 1/sr, without the cosine, one per channel.
 *
 * Functions that can fail return LOBE_OK or another lobe_status, and describe what is wrong in a lobe_error of the caller, or
 * nowhere if that is NULL. Materials and samplers do not change: threads may share them. All text is UTF-8.
 */

#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/**
 * How many bytes a message has at most, with the zero at its end.
 */
#define LOBE_MESSAGE_LENGTH 1024

/**
 * Beyond the outermost angles of a table in specular coordinates, the value at the nearest one.
 */
#define LOBE_EDGES_CLAMP 0

/**
 * Straight lines beyond the ends of all axes; negative values are kept.
 */
#define LOBE_EDGES_EXTRAPOLATE 1

/**
 * 0 beyond sigma and theta.
 */
#define LOBE_EDGES_ZERO 2

/**
 * Grids of half and difference angles (MERL): the value of the bin.
 */
#define LOBE_LOOKUP_NEAREST 0

/**
 * Linear between the centres of bins.
 */
#define LOBE_LOOKUP_LINEAR 1

/**
 * The direction to the light is given.
 */
#define LOBE_GIVEN_LIGHT 0

/**
 * The direction to the viewer is given.
 */
#define LOBE_GIVEN_VIEWER 1

/**
 * Both directions on the same side.
 */
#define LOBE_REFLECTION 0

/**
 * The directions on opposite sides.
 */
#define LOBE_TRANSMISSION 1

/**
 * Light from z > 0.
 */
#define LOBE_SIDE_FRONT 0

/**
 * Light from z < 0.
 */
#define LOBE_SIDE_BACK 1

/**
 * A measured material, in the form in which it was measured. Threads may share it.
 */
typedef struct lobe_material lobe_material;

/**
 * Draws directions for a material in proportion to luminance times f times cosine. Threads may share it.
 */
typedef struct lobe_sampler lobe_sampler;

/**
 * Whether a function did what it was asked for: `LOBE_OK`, or one of `LOBE_ERROR_...`.
 */
typedef int lobe_status;

/**
 * How a material is opened. `lobe_options_default` makes one in which all is left to lobe.
 */
typedef struct {
  /**
   * The instructions, by the name that `lobe_backend_name` gives; NULL is the best that this machine has, or what the
   * environment variable LOBE_BACKEND names.
   */
  const char *backend;
  /**
   * Round the same way on all machines and instructions.
   */
  bool strict;
  /**
   * Keep each call on the thread that makes it, as renderers with threads of their own want. Otherwise batches of 16,384
   * queries or more are shared among threads, with the same bits.
   */
  bool serial;
  /**
   * One of `LOBE_EDGES_...`.
   */
  int edges;
  /**
   * One of `LOBE_LOOKUP_...`.
   */
  int lookup;
  /**
   * Which direction finds the slice of a material of the EPFL database: one of `LOBE_GIVEN_...`.
   */
  int indexed_by;
} lobe_options;

/**
 * Where a function says what is wrong. It belongs to the caller; several threads must not use the same one.
 */
typedef struct {
  /**
   * The same that the function returns.
   */
  lobe_status status;
  /**
   * The line of the file, counted from 1, or 0.
   */
  uint64_t line;
  /**
   * The offset in the file in bytes, or `UINT64_MAX`.
   */
  uint64_t byte;
  /**
   * What is wrong, in words that name the file; ends with a zero, and may be cut.
   */
  char message[LOBE_MESSAGE_LENGTH];
} lobe_error;

/**
 * Directions in memory: `x[i * stride]`, `y[i * stride]` and `z[i * stride]` is direction `i`. Vectors one after the other
 * are `{p, p + 1, p + 2, 3}`, columns `{x, y, z, 1}`; these two are read where they are. With a stride of 0, all are the same.
 */
typedef struct {
  /**
   * x of the first.
   */
  const float *x;
  /**
   * y of the first.
   */
  const float *y;
  /**
   * z of the first.
   */
  const float *z;
  /**
   * Numbers from one direction to the next.
   */
  size_t stride;
} lobe_directions;

/**
 * Where values are written to: value `c` of query `i` at `data[i * query_stride + c * channel_stride]`. Queries one after the
 * other are `{p, channels, 1}`, which is the fastest.
 */
typedef struct {
  /**
   * The first value.
   */
  float *data;
  /**
   * Numbers from one query to the next.
   */
  size_t query_stride;
  /**
   * Numbers from one channel to the next.
   */
  size_t channel_stride;
} lobe_values;

/**
 * Done.
 */
#define LOBE_OK 0

/**
 * An argument makes no sense.
 */
#define LOBE_ERROR_INVALID 1

/**
 * A file cannot be read, is damaged, or is of no known format.
 */
#define LOBE_ERROR_FORMAT 2

/**
 * The material has nothing of the kind that was asked for.
 */
#define LOBE_ERROR_UNSUPPORTED 3

/**
 * A mistake in lobe; please report it.
 */
#define LOBE_ERROR_INTERNAL 4

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * The version of this library, such as "0.1.0".
 */
const char *lobe_version(void);

/**
 * How many backends this machine can run.
 */
size_t lobe_backend_count(void);

/**
 * The name of a backend, the slowest first; NULL if there are not so many.
 */
const char *lobe_backend_name(size_t index);

/**
 * The name of the backend that evaluates a material; NULL of NULL.
 *
 * # Safety
 * `material` is NULL or not freed.
 */
const char *lobe_material_backend(const lobe_material *material);

/**
 * How many channels a value has; 0 of NULL.
 *
 * # Safety
 * `material` is NULL or not freed.
 */
size_t lobe_channel_count(const lobe_material *material);

/**
 * The name of a channel, which lives as long as the material; NULL if there are not so many.
 *
 * # Safety
 * `material` is NULL or not freed.
 */
const char *lobe_channel_name(const lobe_material *material, size_t channel);

/**
 * The wavelength of each channel in nm, which live as long as the material; NULL if channels are no wavelengths.
 *
 * # Safety
 * `material` is NULL or not freed.
 */
const double *lobe_wavelengths(const lobe_material *material);

/**
 * The representation, such as "specular table", which lives as long as the material; NULL of NULL.
 *
 * # Safety
 * `material` is NULL or not freed.
 */
const char *lobe_kind(const lobe_material *material);

/**
 * The name of the format of the file, which lives as long as the material; NULL of NULL.
 *
 * # Safety
 * `material` is NULL or not freed.
 */
const char *lobe_format(const lobe_material *material);

/**
 * How many facts the header of the file states.
 *
 * # Safety
 * `material` is NULL or not freed.
 */
size_t lobe_fact_count(const lobe_material *material);

/**
 * A fact of the header: its name, and its value in `*value`, which live as long as the material. NULL if there are not so many.
 *
 * # Safety
 * `material` is NULL or not freed; `value` points to a pointer or is NULL.
 */
const char *lobe_fact(const lobe_material *material,
                      size_t index,
                      const char **value);

/**
 * Whether values do not depend on the rotation of the sample.
 *
 * # Safety
 * `material` is NULL or not freed.
 */
bool lobe_is_isotropic(const lobe_material *material);

/**
 * Whether there are values for light from a side (`LOBE_SIDE_...`) that is reflected or transmitted (`LOBE_REFLECTION`,
 * `LOBE_TRANSMISSION`).
 *
 * # Safety
 * `material` is NULL or not freed.
 */
bool lobe_holds(const lobe_material *material, int scatter, int side);

/**
 * Bytes of memory that the data take.
 *
 * # Safety
 * `material` is NULL or not freed.
 */
size_t lobe_material_bytes(const lobe_material *material);

/**
 * Opens the file of a measured material, of any format; the content says which. `options` may be NULL. `*material` is set
 * only if this returns LOBE_OK, and is freed with `lobe_material_free`.
 *
 * # Safety
 * `path` is text; `options` is NULL or points to options; `material` points to a pointer, and `error` to an error or is NULL.
 */
lobe_status lobe_open(const char *path,
                      const lobe_options *options,
                      lobe_material **material,
                      lobe_error *error);

/**
 * A material from the content of a file in memory, which is not used any more afterwards. `name` is what the file is called
 * in errors; its extension counts only if the content says too little. All else is as in `lobe_open`.
 *
 * # Safety
 * `data` points to `size` bytes; all else is as in `lobe_open`.
 */
lobe_status lobe_open_bytes(const uint8_t *data,
                            size_t size,
                            const char *name,
                            const lobe_options *options,
                            lobe_material **material,
                            lobe_error *error);

/**
 * Another handle to the same material, to be freed as well; NULL of NULL.
 *
 * # Safety
 * `material` is NULL or a material that is not freed.
 */
lobe_material *lobe_material_share(const lobe_material *material);

/**
 * Frees a handle; nothing happens to NULL. Samplers of the material, and other handles, can still be used.
 *
 * # Safety
 * `material` is NULL or a handle that is not freed, and no other thread uses it.
 */
void lobe_material_free(lobe_material *material);

/**
 * f in 1/sr, without the cosine, of `count` pairs of directions.
 *
 * # Safety
 * `material` is not freed; `wi` and `wo` are `count` directions, and `values` has room for as many queries of all channels,
 * which overlap nothing; `error` points to an error or is NULL.
 */
lobe_status lobe_eval(const lobe_material *material,
                      size_t count,
                      lobe_directions wi,
                      lobe_directions wo,
                      lobe_values values,
                      lobe_error *error);

/**
 * The Mueller matrix in 1/sr for light from `wi` to `wo` at a wavelength in nm: 16 numbers, row by row. LOBE_ERROR_UNSUPPORTED
 * if the material knows no polarisation.
 *
 * # Safety
 * `material` is not freed; `wi` and `wo` point to 3 numbers and `matrix` to room for 16; `error` points to an error or is NULL.
 */
lobe_status lobe_mueller(const lobe_material *material,
                         const float *wi,
                         const float *wo,
                         double wavelength,
                         double *matrix,
                         lobe_error *error);

/**
 * Options in which all is left to lobe.
 */
lobe_options lobe_options_default(void);

/**
 * Builds what samples a material, which takes a while. `defensive`, in (0, 1], is the part of every distribution that is a
 * cosine; 0.05 suits most. `*sampler` is set only if this returns LOBE_OK, and is freed with `lobe_sampler_free`.
 *
 * # Safety
 * `material` is not freed; `sampler` points to a pointer, and `error` to an error or is NULL.
 */
lobe_status lobe_sampler_new(const lobe_material *material,
                             float defensive,
                             lobe_sampler **sampler,
                             lobe_error *error);

/**
 * Frees a sampler; nothing happens to NULL.
 *
 * # Safety
 * `sampler` is NULL or not freed, and no other thread uses it.
 */
void lobe_sampler_free(lobe_sampler *sampler);

/**
 * Draws a direction for each of `count` directions, those to the light or to the viewer (`LOBE_GIVEN_...`), by two numbers in
 * [0, 1) each, `u[2 * i]` and `u[2 * i + 1]`. `drawn` has room for three numbers each, `pdf` for the density per steradian, and
 * `weight`, unless its data is NULL, for f times cosine over the density, one value per channel. If a draw leads nowhere, all
 * are 0; a mirror has an infinite density.
 *
 * # Safety
 * `sampler` is not freed; all pointers are those of `count` queries, and what is written overlaps nothing; `error` points to an
 * error or is NULL.
 */
lobe_status lobe_sample(const lobe_sampler *sampler,
                        int given,
                        size_t count,
                        lobe_directions directions,
                        const float *u,
                        lobe_values drawn,
                        float *pdf,
                        lobe_values weight,
                        lobe_error *error);

/**
 * The density per steradian with which `lobe_sample` finds the direction of each pair that is not given, without mirrors.
 *
 * # Safety
 * `sampler` is not freed; `wi` and `wo` are `count` directions, and `pdf` has room for as many numbers, which overlap nothing;
 * `error` points to an error or is NULL.
 */
lobe_status lobe_pdf(const lobe_sampler *sampler,
                     int given,
                     size_t count,
                     lobe_directions wi,
                     lobe_directions wo,
                     float *pdf,
                     lobe_error *error);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus
