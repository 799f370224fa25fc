/* Traces rays with Embree 3 on request: `embree DIRECTORY`. Answers as described in serve.py.

   A task is SCENE.RAYS.HITS.ISA.TREE: rays of DIRECTORY/SCENE-RAYS.f32 (rows origin, direction, t_min, t_max) through
   the mesh of SCENE-positions.f32 and SCENE-triangles.f32. HITS is `nearest` or `any`, TREE is `fast` or
   `robust`. A run uses the fastest of Embree's calls: 1, 4, 8, 16 rays and streams, each with and without its flag for
   coherent rays. SCENE.build.ISA.TREE builds the tree instead. */

#include <embree3/rtcore.h>
#include <float.h>
#include <immintrin.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MODES = 10, MANY = 64, STREAM = 1024 };

struct mesh {
    char name[64];
    float *positions;
    unsigned *triangles;
    size_t vertices, count;
};

struct tree {
    char name[192];
    RTCScene scene;
};

struct task {
    char name[192];
    const struct mesh *mesh;
    RTCDevice device;
    RTCScene scene;
    int any, robust, build;
    size_t count;
    float *row[8];
    /* Seconds of the first run of each mode. */
    double first[MODES];
};

static const char *directory;
static float *t, *u, *v;
static unsigned *primitive, *geometry;
static size_t room;

static void fail(const char *why, const char *what) {
    fprintf(stderr, "%s: %s\n", what, why);
    exit(1);
}

static double processor_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static float *floats(const char *scene, const char *what, size_t *count) {
    char path[4352];
    snprintf(path, sizeof path, "%s/%s-%s.f32", directory, scene, what);
    FILE *file = fopen(path, "rb");
    if (!file) fail("cannot be opened", path);
    fseek(file, 0, SEEK_END);
    *count = (size_t)ftell(file) / sizeof(float);
    rewind(file);
    /* Embree may read 16 bytes beyond the last vertex. */
    float *values = aligned_alloc(64, (*count * sizeof(float) + 127) / 64 * 64);
    if (!values || fread(values, sizeof(float), *count, file) != *count) fail("cannot be read", path);
    fclose(file);
    return values;
}

static const struct mesh *mesh_named(const char *name) {
    static struct mesh meshes[MANY];
    struct mesh *mesh = meshes;
    for (; mesh < meshes + MANY && mesh->name[0]; mesh++)
        if (!strcmp(mesh->name, name)) return mesh;
    if (mesh == meshes + MANY) fail("too many scenes", name);
    size_t numbers, indices;
    mesh->positions = floats(name, "positions", &numbers);
    float *corners = floats(name, "triangles", &indices);
    mesh->triangles = malloc(indices * sizeof(unsigned));
    if (!mesh->triangles) fail("no memory", name);
    for (size_t at = 0; at < indices; at++) mesh->triangles[at] = (unsigned)corners[at];
    free(corners);
    mesh->vertices = numbers / 3;
    mesh->count = indices / 3;
    snprintf(mesh->name, sizeof mesh->name, "%s", name);
    return mesh;
}

static RTCDevice device_of(const char *isa) {
    static struct { char isa[16]; RTCDevice device; } devices[8];
    for (int at = 0; at < 8; at++) {
        if (!strcmp(devices[at].isa, isa)) return devices[at].device;
        if (devices[at].isa[0]) continue;
        char options[64];
        snprintf(options, sizeof options, "threads=1,isa=%s", isa);
        snprintf(devices[at].isa, sizeof devices[at].isa, "%s", isa);
        return devices[at].device = rtcNewDevice(options);
    }
    fail("too many instruction sets", isa);
    return NULL;
}

static RTCScene built(const struct task *task) {
    const struct mesh *mesh = task->mesh;
    RTCScene scene = rtcNewScene(task->device);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSceneFlags(scene, task->robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    RTCGeometry triangles = rtcNewGeometry(task->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(triangles, RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh->positions, 0, 12,
                               mesh->vertices);
    rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->triangles, 0, 12,
                               mesh->count);
    rtcCommitGeometry(triangles);
    rtcAttachGeometry(scene, triangles);
    rtcReleaseGeometry(triangles);
    rtcCommitScene(scene);
    if (rtcGetDeviceError(task->device) != RTC_ERROR_NONE) fail("Embree reports an error", task->name);
    return scene;
}

static void make_room(size_t count) {
    if (count <= room) return;
    room = (count + 63) / 64 * 64;
    free(t), free(u), free(v), free(primitive), free(geometry);
    t = aligned_alloc(64, room * 4), u = aligned_alloc(64, room * 4), v = aligned_alloc(64, room * 4);
    primitive = aligned_alloc(64, room * 4), geometry = aligned_alloc(64, room * 4);
    if (!t || !u || !v || !primitive || !geometry) fail("no memory", "hits");
}

static void single(const struct task *task, struct RTCIntersectContext *context) {
    float *const *row = task->row;
    for (size_t at = 0; at < task->count; at++) {
        struct RTCRayHit one;
        one.ray.org_x = row[0][at], one.ray.org_y = row[1][at], one.ray.org_z = row[2][at];
        one.ray.dir_x = row[3][at], one.ray.dir_y = row[4][at], one.ray.dir_z = row[5][at];
        one.ray.tnear = row[6][at], one.ray.tfar = row[7][at];
        one.ray.time = 0, one.ray.mask = -1, one.ray.id = 0, one.ray.flags = 0;
        one.hit.geomID = one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        if (task->any) {
            rtcOccluded1(task->scene, context, &one.ray);
            t[at] = one.ray.tfar;
        } else {
            rtcIntersect1(task->scene, context, &one);
            t[at] = one.ray.tfar, u[at] = one.hit.u, v[at] = one.hit.v;
            primitive[at] = one.hit.primID, geometry[at] = one.hit.geomID;
        }
    }
}

#define PACKETS(N)                                                                                                     \
    static void packets##N(const struct task *task, struct RTCIntersectContext *context) {                             \
        float *const *row = task->row;                                                                                 \
        for (size_t at = 0; at < task->count; at += N) {                                                               \
            struct RTCRayHit##N packet;                                                                                \
            int valid[N] __attribute__((aligned(64)));                                                                 \
            size_t left = task->count - at < N ? task->count - at : N;                                                 \
            for (size_t lane = 0; lane < N; lane++) {                                                                  \
                valid[lane] = lane < left ? -1 : 0;                                                                    \
                packet.ray.time[lane] = 0, packet.ray.mask[lane] = -1, packet.ray.id[lane] = 0;                        \
                packet.ray.flags[lane] = 0;                                                                            \
                packet.hit.geomID[lane] = packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;                        \
            }                                                                                                          \
            memcpy(packet.ray.org_x, row[0] + at, 4 * N), memcpy(packet.ray.org_y, row[1] + at, 4 * N);                \
            memcpy(packet.ray.org_z, row[2] + at, 4 * N), memcpy(packet.ray.dir_x, row[3] + at, 4 * N);                \
            memcpy(packet.ray.dir_y, row[4] + at, 4 * N), memcpy(packet.ray.dir_z, row[5] + at, 4 * N);                \
            memcpy(packet.ray.tnear, row[6] + at, 4 * N), memcpy(packet.ray.tfar, row[7] + at, 4 * N);                 \
            if (task->any) {                                                                                           \
                rtcOccluded##N(valid, task->scene, context, &packet.ray);                                              \
                memcpy(t + at, packet.ray.tfar, 4 * N);                                                                \
            } else {                                                                                                   \
                rtcIntersect##N(valid, task->scene, context, &packet);                                                 \
                memcpy(t + at, packet.ray.tfar, 4 * N);                                                                \
                memcpy(u + at, packet.hit.u, 4 * N), memcpy(v + at, packet.hit.v, 4 * N);                              \
                memcpy(primitive + at, packet.hit.primID, 4 * N), memcpy(geometry + at, packet.hit.geomID, 4 * N);     \
            }                                                                                                          \
        }                                                                                                              \
    }

PACKETS(4)
PACKETS(8)
PACKETS(16)

static void streams(const struct task *task, struct RTCIntersectContext *context) {
    static float time[STREAM], normal[3][STREAM];
    static unsigned mask[STREAM], id[STREAM], flags[STREAM], instance[STREAM];
    float *const *row = task->row;
    memset(mask, 255, sizeof mask);
    for (size_t at = 0; at < task->count; at += STREAM) {
        unsigned left = (unsigned)(task->count - at < STREAM ? task->count - at : STREAM);
        memcpy(t + at, row[7] + at, left * 4);
        memset(geometry + at, 255, left * 4);
        memset(instance, 255, left * 4);
        struct RTCRayHitNp all = {
            { row[0] + at, row[1] + at, row[2] + at, row[6] + at, row[3] + at, row[4] + at, row[5] + at, time, t + at,
              mask, id, flags },
            { normal[0], normal[1], normal[2], u + at, v + at, primitive + at, geometry + at, { instance } },
        };
        if (task->any) rtcOccludedNp(task->scene, context, &all.ray, left);
        else rtcIntersectNp(task->scene, context, &all, left);
    }
}

static double run(const struct task *task, int mode) {
    static void (*const ways[])(const struct task *, struct RTCIntersectContext *) = { single, packets4, packets8,
                                                                                       packets16, streams };
    double start = processor_seconds();
    if (task->build) {
        rtcReleaseScene(built(task));
    } else {
        struct RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = mode < MODES / 2 ? RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT : RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        ways[mode % (MODES / 2)](task, &context);
    }
    return processor_seconds() - start;
}

static void first_runs(struct task *task) {
    for (int mode = 0; mode < (task->build ? 1 : MODES); mode++) {
        run(task, mode);
        task->first[mode] = run(task, mode);
        fprintf(stderr, "%s: mode %d takes %.3f ms\n", task->name, mode, 1e3 * task->first[mode]);
    }
}

static struct task *task_named(const char *name) {
    static struct task tasks[4 * MANY];
    static struct tree trees[MANY];
    struct task *task = tasks;
    for (; task < tasks + 4 * MANY && task->name[0]; task++)
        if (!strcmp(task->name, name)) return task;
    if (task == tasks + 4 * MANY) fail("too many tasks", name);
    snprintf(task->name, sizeof task->name, "%s", name);
    char scene[64], rays[64], hits[64] = "", isa[16], tree[16];
    task->build = sscanf(name, "%63[^.].build.%15[^.].%15s", scene, isa, tree) == 3;
    if (!task->build && sscanf(name, "%63[^.].%63[^.].%63[^.].%15[^.].%15s", scene, rays, hits, isa, tree) != 5)
        fail("no task", name);
    task->mesh = mesh_named(scene);
    task->device = device_of(isa);
    task->robust = !strcmp(tree, "robust");
    task->any = !strcmp(hits, "any");
    char key[192];
    snprintf(key, sizeof key, "%s.%s.%s", scene, isa, tree);
    struct tree *held = trees;
    while (held < trees + MANY && held->name[0] && strcmp(held->name, key)) held++;
    if (held == trees + MANY) fail("too many trees", name);
    if (!held->name[0]) {
        snprintf(held->name, sizeof held->name, "%s", key);
        held->scene = built(task);
    }
    task->scene = held->scene;
    if (!task->build) {
        float *all = floats(scene, rays, &task->count);
        task->count /= 8;
        size_t padded = (task->count + 63) / 64 * 64;
        for (int row = 0; row < 8; row++) {
            task->row[row] = aligned_alloc(64, padded * 4);
            if (!task->row[row]) fail("no memory", name);
            memset(task->row[row], 0, padded * 4);
            memcpy(task->row[row], all + (size_t)row * task->count, task->count * 4);
        }
        free(all);
        make_room(task->count);
    }
    first_runs(task);
    return task;
}

/* The least time of runs, in seconds, among the modes that can still be the fastest. */
static double least(const struct task *task, int times) {
    int modes = task->build ? 1 : MODES;
    double best = DBL_MAX, fastest = DBL_MAX;
    for (int mode = 0; mode < modes; mode++) fastest = fmin(fastest, task->first[mode]);
    for (int mode = 0; mode < modes; mode++)
        for (int time = 0; time < times && task->first[mode] < 1.5 * fastest; time++)
            best = fmin(best, run(task, mode));
    return best;
}

/* The tree's box; or 0 and 1 for rays that reach their end and those that do not; or t and the two halves of the
   triangle's number, -1 for a miss. */
static int write_values(const struct task *task, FILE *out) {
    if (task->build) {
        struct RTCBounds box;
        rtcGetSceneBounds(task->scene, &box);
        float all[6] = { box.lower_x, box.lower_y, box.lower_z, box.upper_x, box.upper_y, box.upper_z };
        return fwrite(all, sizeof all, 1, out) == 1;
    }
    run(task, 0);
    for (int part = 0; part < (task->any ? 1 : 3); part++)
        for (size_t at = 0; at < task->count; at++) {
            int hit = task->any ? t[at] < 0 : geometry[at] != RTC_INVALID_GEOMETRY_ID;
            float found = part == 0 ? t[at] : part == 1 ? (float)(primitive[at] & 4095) : (float)(primitive[at] >> 12);
            float value = task->any ? (float)hit : hit ? found : -1;
            if (fwrite(&value, sizeof value, 1, out) != 1) return 0;
        }
    return 1;
}

int main(int argc, char **argv) {
    if (argc != 2) return 1;
    directory = argv[1];
    /* As recommended by its manual. */
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    printf("ready %s\n", RTC_VERSION_STRING);
    fflush(stdout);

    char what[16], name[192], argument[4096];
    while (scanf("%15s %191s %4095[^\n]", what, name, argument) == 3) {
        struct task *task = task_named(name);
        if (what[0] == 'r') {
            printf("%.9e\n", least(task, atoi(argument)));
        } else {
            FILE *out = fopen(argument, "wb");
            if (!out || !write_values(task, out) || fclose(out)) fail("cannot be written", argument);
            printf("written\n");
        }
        fflush(stdout);
    }
    return 0;
}
