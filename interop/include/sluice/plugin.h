/* SPDX-License-Identifier: MIT
 *
 * sluice/plugin.h - the C ABI between a Sluice host and a renderer plugin.
 *
 * This header is the contract. It is C99, includes nothing of OpenGL or Vulkan, and is the only thing that the two
 * sides share at run time.
 *
 * THE SHAPE OF IT
 *   A renderer is a shared library that exports one symbol, SLUICE_RENDERER_ENTRY_SYMBOL. The host calls it with the
 *   ABI version that it was built against and gets a table of functions, or NULL if the renderer cannot serve it.
 *   The renderer allocates every shared image (OpenGL can import memory but not export it) and gives each one to the
 *   host through SluiceHostServices::share_image. The two then take turns, ordered by two 64-bit counters.
 *
 * GROWTH
 *   Every struct that crosses by pointer begins with `struct_size`, set by its owner to its own sizeof before the call,
 *   for structs that the call fills as well. A reader uses a field only if struct_size covers it and treats a missing
 *   one as zero; a call that fills a struct writes no further than struct_size and leaves in it the bytes that it knew.
 *   Fields are only ever appended within one ABI major, and nothing is shorter than in its ABI 1.0 (sluice/
 *   abi_sizes.hpp has those sizes): a smaller struct_size, zero included, is SLUICE_ERROR_INVALID_ARGUMENT. Major
 *   differs: refuse. Minor differs: both sides use the fields that both know.
 *   Structs that stand inside others by value keep their size for good; they grow into their `reserved` words, which
 *   the side that fills the struct sets to zero and a reader that knows no meaning for them ignores.
 *
 * THREADS
 *   All renderer functions are called on the thread that owns the host's GL context, with that context current, because
 *   they may call back into host services that issue GL commands. The exceptions, callable from any thread at any time
 *   between create and destroy, are timeline_signal, timeline_wait and timeline_value; and simulation_wait,
 *   simulation_stats and simulation_bodies, but not while set_simulation runs.
 *   A renderer may call SluiceHostServices::log and ::trace from any thread; share_image, retire_image and canary only
 *   from inside create, resize, destroy or probe_format, on the calling thread.
 *
 * OWNERSHIP
 *   - Pointers given to a function are valid for that call only, unless stated otherwise.
 *   - A file descriptor passes to the receiver only when the call returns SLUICE_OK; on any other result the caller
 *     still owns it and must close it. This holds in both directions.
 *   - A shared image is held by exactly one side at a time; docs/protocol.md has the table of states and values.
 *
 * COORDINATES AND UNITS
 *   World and eye space are right-handed, in metres; eye space looks down -z, +y is up. Matrices are column-major and
 *   multiply column vectors. Projection follows OpenGL: clip z in [-w, w], NDC y up.
 *   Texel (0,0) of every shared image is the BOTTOM left of the picture, as in OpenGL. (A Vulkan viewport of positive
 *   height with an OpenGL projection matrix writes exactly that.) Colours in HOST_COLOUR and FLUID_COLOUR are
 *   sRGB-encoded values in non-sRGB formats, as an engine of 2004 keeps them; all light quantities are linear.
 *
 * ERRORS
 *   No function aborts, throws across the boundary or prints. Failures return a negative SluiceResult and, where there
 *   is a SluiceError parameter, a message that names the thing, the value and the remedy.
 */
#ifndef SLUICE_PLUGIN_H
#define SLUICE_PLUGIN_H

/* C99: what clang-tidy would modernise in C++ has to stay as it is.
 * NOLINTBEGIN(modernize-*,performance-enum-size,bugprone-macro-parentheses) */
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SLUICE_ABI_MAJOR 1u
#define SLUICE_ABI_MINOR 3u
/* No casts in these macros: C++ readers of this header compile with -Wold-style-cast. */
#define SLUICE_MAKE_ABI(major, minor) (((major) << 16u) | (minor))
#define SLUICE_ABI_VERSION SLUICE_MAKE_ABI(SLUICE_ABI_MAJOR, SLUICE_ABI_MINOR)
#define SLUICE_RENDERER_ENTRY_SYMBOL "sluice_renderer_entry"
#define SLUICE_UUID_SIZE 16u
#define SLUICE_MAX_DEVICE_UUIDS 4u
#define SLUICE_MAX_IMAGE_SETS 4u
#define SLUICE_MAX_PASSES 32u
#define SLUICE_MAX_IMAGE_ROLES 16u /* room in arrays by role; SluiceImageRole may grow up to it */
#define SLUICE_MAX_EXTENT 16384u   /* largest width or height of a shared image or an environment map, in texels */

/* Results. Zero and positive values are not failures. A plain integer at the boundary: a broken renderer may return any
 * number, and one outside a C++ enumeration would be undefined behaviour in the host. */
typedef int32_t SluiceResult;
enum SluiceResultCode {
    SLUICE_OK = 0,
    SLUICE_NOT_READY = 1, /* poll: that frame has not finished yet */
    SLUICE_TIMEOUT = 2,   /* timeline_wait: the deadline passed; nothing was lost, wait again or give up */
    SLUICE_ERROR_INVALID_ARGUMENT = -1, /* the caller broke this contract */
    SLUICE_ERROR_ABI_MISMATCH = -2,
    SLUICE_ERROR_UNSUPPORTED = -3,     /* this device or driver lacks something; the message says what */
    SLUICE_ERROR_DEVICE_MISMATCH = -4, /* no Vulkan device has the UUIDs of the GL context */
    SLUICE_ERROR_OUT_OF_MEMORY = -5,
    SLUICE_ERROR_DEVICE_LOST = -6, /* destroy and create again */
    SLUICE_ERROR_CANARY = -7,      /* a shared image did not carry its contents across; see the message */
    SLUICE_ERROR_IMPORT = -8,      /* the host could not import a memory object */
    SLUICE_ERROR_INTERNAL = -9
};

/* One failure, told to a person. message is NUL-terminated: what failed, the value, the remedy. */
typedef struct SluiceError {
    uint32_t struct_size;
    int32_t code; /* SluiceResult */
    char message[512];
} SluiceError;

/* Formats that both APIs can name; sluice/format.hpp holds the table of what each is on either side. Values are ABI. */
typedef enum SluiceFormat {
    SLUICE_FORMAT_NONE = 0,
    SLUICE_FORMAT_R8 = 1,
    SLUICE_FORMAT_RGBA8 = 2,
    SLUICE_FORMAT_SRGB8_A8 = 3,
    SLUICE_FORMAT_RGB10_A2 = 4,
    SLUICE_FORMAT_R16F = 5,
    SLUICE_FORMAT_RG16F = 6,
    SLUICE_FORMAT_RGBA16F = 7,
    SLUICE_FORMAT_R32F = 8,
    SLUICE_FORMAT_RG32F = 9,
    SLUICE_FORMAT_RGBA32F = 10,
    SLUICE_FORMAT_R32UI = 11,
    SLUICE_FORMAT_D32F = 12,
    SLUICE_FORMAT_D24S8 = 13,
    SLUICE_FORMAT_COUNT = 14
} SluiceFormat;

/* What a shared image is for. */
typedef enum SluiceImageRole {
    SLUICE_IMAGE_HOST_COLOUR = 0,  /* host writes: its frame before fluid, sRGB-encoded, for refraction */
    SLUICE_IMAGE_HOST_DEPTH = 1,   /* host writes: its depth, in SluiceRendererInfo::host_depth_encoding */
    SLUICE_IMAGE_FLUID_COLOUR = 2, /* renderer writes: sRGB-encoded colour, not premultiplied; alpha = coverage */
    SLUICE_IMAGE_FLUID_DEPTH = 3,  /* renderer writes: 32-bit float window depth in [0,1]; 1 where there is no fluid */
    SLUICE_IMAGE_FLUID_NORMAL = 4, /* renderer writes: xyz = unit eye-space normal, w = 1 on fluid and 0 elsewhere */
    SLUICE_IMAGE_FLUID_THICKNESS = 5, /* renderer writes: metres of fluid along the view ray */
    SLUICE_IMAGE_CANARY = 6,          /* short-lived, for proving a format; never part of a frame */
    SLUICE_IMAGE_ROLE_COUNT = 7
} SluiceImageRole;

#define SLUICE_ROLE_BIT(role) (1u << (role))

typedef enum SluiceDepthEncoding {
    SLUICE_DEPTH_WINDOW = 0, /* OpenGL window depth in [0,1], default glDepthRange */
    SLUICE_DEPTH_LINEAR = 1  /* metres in front of the eye, along -z; +infinity where nothing was drawn */
} SluiceDepthEncoding;

/* How the two sides order their work. All have one meaning; docs/protocol.md. */
typedef enum SluiceTimelineKind {
    SLUICE_TIMELINE_AUTO = 0,    /* request only: the best that the probe proves */
    SLUICE_TIMELINE_NATIVE = 1,  /* GL_NV_timeline_semaphore with an exported Vulkan timeline semaphore */
    SLUICE_TIMELINE_BINARY = 2,  /* GL_EXT_semaphore_fd: one exported binary semaphore per value */
    SLUICE_TIMELINE_BRIDGED = 3, /* GL fence + client wait + vkSignalSemaphore; vkWaitSemaphores on the way back */
    SLUICE_TIMELINE_FINISH = 4,  /* glFinish and an idle queue: the baseline to compare with */
    SLUICE_TIMELINE_UNSYNCHRONISED = 5, /* request only, never chosen: no waits at all, to show that tests notice */
    SLUICE_TIMELINE_KIND_COUNT = 6
} SluiceTimelineKind;

typedef enum SluiceDirection {
    SLUICE_HOST_TO_RENDERER = 0, /* frame k: 2k-1 = GBuffer written, 2k = fluid images read by the composite */
    SLUICE_RENDERER_TO_HOST = 1, /* frame k: k = fluid images written and GBuffer no longer read */
    /* Since ABI 1.1, in trace events alone; value v = the fluid of v lies in its output slot. */
    SLUICE_SIMULATION_TO_RENDERER = 2
} SluiceDirection;

typedef enum SluiceLogLevel {
    SLUICE_LOG_DEBUG = 0,
    SLUICE_LOG_INFO = 1,
    SLUICE_LOG_WARNING = 2,
    SLUICE_LOG_ERROR = 3
} SluiceLogLevel;

/* ------------------------------------------------------------------------------------------------------ trace -- */

typedef enum SluiceTraceKind {
    SLUICE_TRACE_SIGNAL = 0,  /* value = timeline value made visible */
    SLUICE_TRACE_WAIT = 1,    /* value = timeline value waited for; duration = time blocked, 0 for a GPU-side wait */
    SLUICE_TRACE_ACQUIRE = 2, /* a side takes a shared image; bytes = its size */
    SLUICE_TRACE_RELEASE = 3, /* a side gives a shared image up; bytes = its size */
    SLUICE_TRACE_SUBMIT = 4,
    SLUICE_TRACE_PASS = 5,     /* one GPU pass; bytes = bytes it touched at least once (compulsory traffic) */
    SLUICE_TRACE_CPU_COPY = 6, /* bytes moved by the CPU between its memory and an image or buffer; never in a frame
                                  loop for a shared image */
    SLUICE_TRACE_MARK = 7,
    SLUICE_TRACE_KIND_COUNT = 8
} SluiceTraceKind;

typedef enum SluiceTrack {
    SLUICE_TRACK_HOST_CPU = 0,
    SLUICE_TRACK_HOST_GL = 1,
    SLUICE_TRACK_BRIDGE = 2,
    SLUICE_TRACK_RENDERER_CPU = 3,
    SLUICE_TRACK_RENDERER_QUEUE = 4,
    SLUICE_TRACK_SIMULATION = 5, /* since ABI 1.1: the queue and the thread of the simulation */
    SLUICE_TRACK_COUNT = 6
} SluiceTrack;

/* One event. Times are CLOCK_MONOTONIC nanoseconds. name is copied by the receiver (truncated to 31 characters). */
typedef struct SluiceTraceEvent {
    uint32_t struct_size;
    uint32_t kind;      /* SluiceTraceKind */
    uint32_t track;     /* SluiceTrack */
    uint32_t direction; /* SluiceDirection, for SIGNAL and WAIT */
    uint64_t begin_ns;
    uint64_t duration_ns;
    uint64_t frame;
    uint64_t value;
    uint64_t bytes;
    const char* name;
} SluiceTraceEvent;

/* ---------------------------------------------------------------------------------------------- shared images -- */

/* One image that the renderer has allocated and exported: dedicated allocation, image bound at offset 0, optimal
 * tiling, one mip, one layer, one sample. */
typedef struct SluiceImageExport {
    uint32_t struct_size;
    uint32_t role;      /* SluiceImageRole */
    uint32_t image_set; /* which set of the ring, from 0 */
    uint32_t format;    /* SluiceFormat */
    uint32_t width, height;
    uint64_t allocation_size; /* the VkMemoryAllocateInfo size, in bytes */
    int32_t fd;               /* opaque fd; becomes the host's on SLUICE_OK */
    uint32_t dedicated;       /* 1: GL_DEDICATED_MEMORY_OBJECT_EXT must be set before the import */
} SluiceImageExport;

/* What the host offers. `user` is passed back as the first argument of each function. */
typedef struct SluiceHostServices {
    uint32_t struct_size;
    uint32_t abi_version;
    void* user;

    /* Any thread. message is one line without a newline. */
    void (*log)(void* user, int32_t level, const char* message);

    /* Any thread. NULL when tracing is off: then no events are sent. (The renderer takes its timestamps all the same:
     * they also feed SluiceFrameStats.) */
    void (*trace)(void* user, const SluiceTraceEvent* event);

    /* The allocator of shared images, seen from the renderer: it brings exportable memory, the host binds it to a
     * texture and keeps it until retire_image. A second export for the same (role, image_set) replaces the first. */
    SluiceResult (*share_image)(void* user, const SluiceImageExport* image, SluiceError* error);
    void (*retire_image)(void* user, uint32_t role, uint32_t image_set);

    /* Prove a format. The renderer has filled the image with sluice::canaryPattern(format, seed) and finished; the host
     * imports it, compares every texel, overwrites it with canaryPattern(format, seed + 1), finishes and lets go of it.
     * SLUICE_ERROR_CANARY if a texel differed. The renderer then checks the host's pattern. */
    SluiceResult (*canary)(void* user, const SluiceImageExport* image, uint32_t seed, SluiceError* error);
} SluiceHostServices;

/* What the GL side of this machine can do, as queried; the input of sluice::negotiate. */
typedef struct SluiceHostCapabilities {
    uint32_t struct_size;
    uint32_t device_uuid_count;
    uint8_t device_uuids[SLUICE_MAX_DEVICE_UUIDS][SLUICE_UUID_SIZE];
    uint8_t driver_uuid[SLUICE_UUID_SIZE];
    uint32_t has_memory_object;      /* GL_EXT_memory_object */
    uint32_t has_memory_object_fd;   /* GL_EXT_memory_object_fd */
    uint32_t has_semaphore;          /* GL_EXT_semaphore */
    uint32_t has_semaphore_fd;       /* GL_EXT_semaphore_fd */
    uint32_t has_timeline_semaphore; /* GL_NV_timeline_semaphore */
    uint32_t has_sync;               /* GL_ARB_sync or GL 3.2 */
    uint32_t has_framebuffer_object; /* GL_ARB_framebuffer_object or GL 3.0 */
    uint32_t texture_formats;        /* bit per SluiceFormat: usable as a texture */
    uint32_t attachment_formats;     /* bit per SluiceFormat: framebuffer complete when attached */
    char vendor[64], renderer[128], version[64];
    uint32_t reserved[8]; /* zero */
} SluiceHostCapabilities;

/* The same for the Vulkan device. */
typedef struct SluiceRendererCapabilities {
    uint32_t struct_size;
    uint32_t api_version; /* VK_MAKE_API_VERSION */
    uint8_t device_uuid[SLUICE_UUID_SIZE];
    uint8_t driver_uuid[SLUICE_UUID_SIZE];
    uint32_t has_external_memory_fd;
    uint32_t has_timeline_semaphore;
    uint32_t exports_timeline_fd; /* timeline semaphores as OPAQUE_FD */
    uint32_t exports_binary_fd;   /* binary semaphores as OPAQUE_FD */
    uint32_t queue_families, queues;
    uint32_t exportable_formats; /* bit per SluiceFormat: exportable with the usages that frames need */
    uint32_t storage_formats;    /* bit per SluiceFormat: usable as a storage image */
    uint32_t blendable_formats;  /* bit per SluiceFormat: colour attachment with blending */
    char device_name[128], driver_name[64], driver_info[128];
    uint32_t reserved[8]; /* [0]: the most particles that set_particles takes, 0 if not said; the others zero */
} SluiceRendererCapabilities;

/* ------------------------------------------------------------------------------------------------------ scene -- */

typedef struct SluiceCamera {
    float view[16];              /* world to eye */
    float projection[16];        /* eye to clip, OpenGL convention, perspective and symmetric or not */
    float near_plane, far_plane; /* metres, 0 < near < far */
    uint32_t reserved[4];        /* zero */
} SluiceCamera;

/* One distant light and the procedural sky, all linear. For a unit direction d (world):
 *   base  = d.y >= 0 ? mix(horizon, zenith, sqrt(d.y)) : mix(horizon, ground, min(1, -4 d.y))
 *   sky(d) = base + sun_radiance * smoothstep(cos 2.5 deg, cos 1.0 deg, dot(d, to_sun))
 * The host draws its sky with the same formula, so that reflections agree with it. */
typedef struct SluiceSky {
    float zenith[3], horizon[3], ground[3];
    float to_sun[3]; /* unit, world */
    float sun_radiance[3];
    uint32_t reserved[4]; /* zero */
} SluiceSky;

typedef enum SluiceFilterKind {
    SLUICE_FILTER_NONE = 0,
    SLUICE_FILTER_NARROW_RANGE = 1 /* Truong & Yuksel 2018 */
} SluiceFilterKind;

typedef enum SluiceView {
    SLUICE_VIEW_FLUID = 0, /* the shaded fluid */
    SLUICE_VIEW_DEPTH = 1, /* debug views: the named buffer as colours, coverage 1 on fluid */
    SLUICE_VIEW_NORMAL = 2,
    SLUICE_VIEW_THICKNESS = 3,
    SLUICE_VIEW_ECHO = 4 /* FLUID_COLOUR = HOST_COLOUR and FLUID_DEPTH = HOST_DEPTH, texel for texel: checks the
                            hand-off without any fluid */
} SluiceView;

/* How the fluid looks. Lengths "in radii" are multiples of the particle radius. */
typedef struct SluiceFluid {
    float absorption[3];       /* per metre, linear RGB: Beer's law transmits exp(-absorption * thickness) */
    float scatter_colour[3];   /* linear RGB in-scattered in the limit of infinite thickness */
    float index_of_refraction; /* 1.33 for water, > 1 */
    float specular_power;      /* Blinn-Phong exponent of the sun's highlight */
    float splat_radius;        /* in radii; 1.5 */
    uint32_t filter;           /* SluiceFilterKind */
    uint32_t filter_iterations;
    float filter_range;         /* in radii: half-width delta of the narrow range */
    float filter_clamp;         /* in radii: mu, how far below the centre a farther sample is clamped */
    float filter_sigma;         /* in radii: world-space standard deviation of the spatial weight */
    uint32_t filter_max_pixels; /* cap of the filter's half-width in pixels */
    float thickness_scale;      /* resolution of the thickness pass: 1, 0.5 or 0.25 */
    float thickness_blur;       /* in radii: standard deviation of the Gaussian; 0 turns the blur off */
    uint32_t refraction;        /* 0: the host's colour is not sampled */
    uint32_t reflection;        /* 0: no environment is sampled */
    uint32_t view;              /* SluiceView */
    uint32_t ellipsoids;        /* since ABI 1.2: 1: what a simulation shaped is drawn so, see its anisotropy */
    /* Since ABI 1.3: how much the foam of a simulation (see its foam_life) hides: a particle's diameter of it lets
     * exp(-foam) of the water through; 0: it is not drawn. */
    float foam;
    uint32_t reserved[6]; /* zero */
} SluiceFluid;

#define SLUICE_MAX_FLUIDS 8u /* since ABI 1.3, as SluiceLook and what names fluids below */

/* How one of several fluids looks, where that is not as SluiceFluid says. Stands in an array, so its size is for good.
 */
typedef struct SluiceLook {
    float absorption[3];  /* per metre, linear RGB: of mixed fluids their sum along the ray counts */
    uint32_t reserved[5]; /* zero */
} SluiceLook;

/* A particle set on the CPU. Arrays are tightly packed float triples in world metres; velocity and colour may be NULL.
 */
typedef struct SluiceParticles {
    uint32_t struct_size;
    uint32_t count;
    float radius; /* metres, > 0 */
    const float* position;
    const float* velocity; /* metres per second */
    const float* colour;   /* linear RGB in [0,1] */
    const uint32_t* fluid; /* since ABI 1.3: the number of its fluid, for its look; NULL: 0 */
} SluiceParticles;

/* A latitude-longitude environment map: linear RGB, rows from the zenith down, column 0 looks along -z and columns turn
 * towards +x. pixels is read during the call only. */
typedef struct SluiceEnvironment {
    uint32_t struct_size;
    uint32_t width, height;
    const float* pixels;
} SluiceEnvironment;

/* What the scene asks of the renderer; the input of the pass plan. */
typedef struct SluiceSceneNeeds {
    uint32_t struct_size;
    uint32_t width, height;
    uint32_t particle_count;
    uint32_t has_environment_map;
    uint32_t outputs; /* SLUICE_ROLE_BIT of each FLUID_* image that the host reads; colour and depth are always made */
    SluiceFluid fluid;
    uint32_t other_look_count; /* since ABI 1.3: as SluiceFrame has it, of particles that name fluids */
} SluiceSceneNeeds;

typedef enum SluiceFrameFlags {
    SLUICE_FRAME_SKIP_WAIT = 1,            /* fault for tests: do not wait for wait_value */
    SLUICE_FRAME_SKIP_SIMULATION_WAIT = 2, /* since ABI 1.1, likewise: do not wait for the simulation */
    /* Since ABI 1.2: a simulation with depth_scale collides with this frame's HOST_DEPTH. Counts in the first frame
     * that draws its value; needs a perspective, and a camera that only turns and moves. */
    SLUICE_FRAME_CAPTURE_DEPTH = 4
} SluiceFrameFlags;

/* One frame. Frames are numbered from 1 without gaps. */
typedef struct SluiceFrame {
    uint32_t struct_size;
    uint32_t image_set;    /* (frame - 1) % image_sets */
    uint64_t frame;        /* k */
    uint64_t wait_value;   /* host-to-renderer value to wait for: 2k-1 */
    uint64_t signal_value; /* renderer-to-host value to signal: k */
    uint32_t outputs;      /* as in SluiceSceneNeeds */
    uint32_t flags;        /* SluiceFrameFlags */
    SluiceCamera camera;
    SluiceSky sky;
    SluiceFluid fluid;
    uint64_t simulation; /* since ABI 1.1: the value of the simulation to draw; 0: the particles of set_particles */
    /* Since ABI 1.3: how the fluids after the first look, which looks as `fluid` says, as do those beyond the count.
     * Where all look alike the frame costs what it costs without them. */
    uint32_t other_look_count;
    SluiceLook other_looks[SLUICE_MAX_FLUIDS - 1u];
} SluiceFrame;

/* ------------------------------------------------------------------------------------- simulation, since ABI 1.1 -- */

typedef enum SluiceSolidKind {
    SLUICE_SOLID_PLANE = 0,  /* a: normal, need not be unit; b: a point of it. Solid is the side away from the normal */
    SLUICE_SOLID_SPHERE = 1, /* a: centre; radius */
    SLUICE_SOLID_CAPSULE = 2, /* all within radius of the line from a to b */
    SLUICE_SOLID_BOX = 3,     /* a: centre; b: half extents; turned by turn_degrees about +y */
    SLUICE_SOLID_KIND_COUNT = 4
} SluiceSolidKind;

/* Something that fluid stays out of; metres. Stands in an array, so its size is for good. */
typedef struct SluiceSolid {
    uint32_t kind; /* SluiceSolidKind */
    float a[3], b[3];
    float radius, turn_degrees;
    uint32_t reserved[7]; /* zero */
} SluiceSolid;

#define SLUICE_MAX_FRAMES_IN_FLIGHT 3u

/* Since ABI 1.2, as what follows until SluiceSimulation. All of these stand in arrays, so their sizes are for good. */
#define SLUICE_MAX_EMITTERS 16u
#define SLUICE_MAX_DRAINS 16u
#define SLUICE_MAX_FIELDS 16u
#define SLUICE_MAX_BODIES 16u

typedef enum SluiceOpening { SLUICE_OPENING_DISC = 0, SLUICE_OPENING_RECTANGLE = 1 } SluiceOpening;

/* A nozzle. */
typedef struct SluiceEmitter {
    uint32_t shape; /* SluiceOpening */
    float centre[3];
    float direction[3];  /* out of the opening; need not be unit */
    float width, height; /* metres; a disc has its diameter in both */
    float speed, rate;   /* m/s, > 0; particles per second, 0: as dense as the fluid at rest */
    float start, stop;   /* seconds of the simulation's time; stop 0: never */
    uint32_t fluid;      /* since ABI 1.3: what comes out of it, as in SluiceSimulation::particle_fluids */
    uint32_t reserved[6];
} SluiceEmitter;

typedef enum SluiceRegion { SLUICE_REGION_SPHERE = 0, SLUICE_REGION_BOX = 1 } SluiceRegion;

/* Takes every particle that ends a step in it. */
typedef struct SluiceDrain {
    uint32_t shape; /* SluiceRegion; a box lies along the axes */
    float centre[3];
    float half[3]; /* metres; a sphere's radius is the first */
    uint32_t reserved[5];
} SluiceDrain;

typedef enum SluiceFieldKind {
    SLUICE_FIELD_WIND = 0,  /* blows along axis */
    SLUICE_FIELD_POINT = 1, /* pulls to centre */
    SLUICE_FIELD_VORTEX = 2 /* turns about the line through centre along axis */
} SluiceFieldKind;

/* An acceleration beside gravity. */
typedef struct SluiceForceField {
    uint32_t kind; /* SluiceFieldKind */
    float centre[3];
    float axis[3];          /* of any length but 0 */
    float strength, radius; /* m/s^2 where it is strongest; nothing beyond radius, 0: the same everywhere */
    uint32_t reserved[7];
} SluiceForceField;

typedef enum SluiceBodyMotion {
    SLUICE_BODY_FREE = 0,  /* gravity, the fluid, solids and other bodies move it */
    SLUICE_BODY_PATH = 1,  /* goes where its path says, and nothing stops it */
    SLUICE_BODY_DRIVEN = 2 /* goes where set_body says, and nothing stops it */
} SluiceBodyMotion;

/* A rigid body, as it is at the start. */
typedef struct SluiceBody {
    uint32_t shape;  /* SluiceSolidKind: sphere, capsule (upright) or box */
    uint32_t motion; /* SluiceBodyMotion */
    float centre[3];
    float half[3]; /* of the box about it: a sphere's radius three times; a capsule's radius, half length, radius */
    float turn_degrees;              /* about +y */
    float density;                   /* of a free one, in densities of the fluid at rest */
    float velocity[3], spin[3];      /* m/s, rad/s */
    uint32_t path_first, path_count; /* its points among SluiceSimulation::path_points */
    uint32_t reserved[6];
} SluiceBody;

/* Between its points a body goes straight on; after the last it rests. */
typedef struct SluicePathPoint {
    float time; /* seconds of the simulation's time, ascending */
    float centre[3];
    float turn_degrees;
    uint32_t reserved[3];
} SluicePathPoint;

/* A closed surface; triangles counter-clockwise as seen from outside. Its corners and triangles follow those of the
 * mesh before it in SluiceSimulation::mesh_corners and ::mesh_indices; indices count from its own first corner. */
typedef struct SluiceMesh {
    uint32_t corner_count, triangle_count;
    uint32_t reserved[6];
} SluiceMesh;

/* Since ABI 1.3. What the density of a fluid is measured with. */
typedef enum SluiceDensityKernel {
    SLUICE_KERNEL_DEFAULT = 0, /* poly6 */
    SLUICE_KERNEL_POLY6 = 1,
    SLUICE_KERNEL_SPLINE = 2,
    SLUICE_KERNEL_WENDLAND = 3,
    SLUICE_KERNEL_COUNT = 4
} SluiceDensityKernel;

/* Since ABI 1.3. What the particles of one of several fluids are made of; all have the same volume at rest. Stands in
 * an array, so its size is for good. */
typedef struct SluiceFluidKind {
    float density;           /* at rest, of water at rest; the heaviest is at most 16 times as dense as the lightest */
    float viscosity;         /* of XSPH, 0 to 1; between two fluids their mean */
    float tension, adhesion; /* m/s^2; between two fluids the geometric mean of their tensions */
    uint32_t reserved[4];    /* zero */
} SluiceFluidKind;

/* A fluid that the renderer lets flow by itself; docs/simulation.md has every number. Metres, seconds. Arrays are
 * tightly packed and copied during the call. */
typedef struct SluiceSimulation {
    uint32_t struct_size;
    uint32_t frames_in_flight; /* 1..SLUICE_MAX_FRAMES_IN_FLIGHT: values that may be asked for and not drawn yet */
    float radius;              /* of a particle */
    float low[3], high[3];     /* the box that nothing leaves */
    float gravity[3];
    uint32_t iterations;
    float relaxation, tensile, viscosity, vorticity, cfl;
    double longest_step; /* seconds, above 0, at most 1 */
    uint32_t solid_count, particle_count;
    const SluiceSolid* solids;
    const float* position;
    const float* velocity; /* may be NULL: at rest */

    /* ABI 1.1 ends here. */
    float tension, adhesion; /* m/s^2: gamma and beta of Akinci et al. 2013; 0: none */
    float overshoot;         /* longest step for a depth; 0: the default of 0.17; below 0: steps are not held to it */
    uint32_t max_particles;  /* at which emitters stop, and room for reset_simulation; 0 without emitters: as given */
    uint32_t emitter_count, drain_count, field_count, body_count;
    const SluiceEmitter* emitters; /* with one, particle_count may be 0 */
    const SluiceDrain* drains;
    const SluiceForceField* fields;
    const SluiceBody* bodies; /* not with meshes, which they would not meet */
    const SluicePathPoint* path_points;
    const SluiceMesh* meshes;
    const float* mesh_corners;    /* triples, metres */
    const uint32_t* mesh_indices; /* three a triangle */
    uint32_t path_point_count, mesh_count;
    uint32_t mesh_corner_count, mesh_triangle_count; /* of all meshes together */
    float anisotropy;        /* greatest ratio of a particle's axes, 1 to 10; 0: particles have no shape */
    float smoothing, lonely; /* 0 to 1: how far centres go to their neighbours' mean; size without neighbours, 0: 0.5 */
    uint32_t density_kernel; /* since ABI 1.3: SluiceDensityKernel */
    /* What the host's depth buffer shows is solid, too: value v collides with what was captured
     * (SLUICE_FRAME_CAPTURE_DEPTH) by the frame that draws value v - depth_lag, but at least 1, and waits for it; by
     * value 1 nothing has been seen. A frame without the flag, or a value that no frame draws, leaves what was captured
     * before. */
    uint32_t depth_scale; /* pixels each way that become one, the nearest of them: 1..8; 0: the depth is no solid */
    uint32_t depth_lag; /* 1..frames_in_flight; 0: frames_in_flight, with which the simulation runs beside the frames */
    float depth_thickness;   /* metres that what is seen is deep for who comes round its edge; 0: a radius */
    uint32_t depth_reserved; /* zero */

    /* ABI 1.2 ends here. */
    /* Where the water turns white (Ihmsen et al. 2012), for frames with SluiceFluid::foam. Each pair: from where a
     * potential counts, and from where it is 1; 0, 0: the default. */
    float foam_life;                 /* seconds after which half of a particle's foam is left; 0: there is none */
    float foam_air[2];               /* trapped air, m/s summed over neighbours; 5, 20 */
    float foam_crest[2];             /* curvature of a breaking crest, summed over neighbours; 2, 8 */
    float foam_energy[2];            /* half the square of the speed, m^2/s^2; 5, 50 */
    uint32_t foam_reserved;          /* zero */
    const SluiceFluidKind* fluids;   /* none: one of density 1, with the viscosity, tension and adhesion above */
    const uint32_t* particle_fluids; /* for each particle, its place in `fluids`; none: all are of the first */
    uint32_t fluid_count;            /* 0 to SLUICE_MAX_FLUIDS */
    uint32_t particle_fluid_count;   /* 0, or particle_count */
} SluiceSimulation;

typedef struct SluiceSimulationStats {
    uint32_t struct_size;
    uint32_t particle_count;
    uint64_t asked;   /* last value that simulate was called with */
    uint64_t reached; /* of the timeline */
    uint64_t failed;  /* first value that could not be simulated, 0: none since the last reset_simulation; from it on
                         all are the last good state */
    uint64_t steps, steps_taken_again;
    uint64_t busy_ns;              /* spent on values, waiting for the queue included, since set_simulation */
    uint64_t last_busy_ns;         /* of that, on the value that was reached last */
    double shortest_step, fastest; /* seconds; metres per second */
    uint32_t own_queue;            /* 1: a queue of its own; 0: it takes turns with the frames */
    char message[508];             /* why `failed` failed */
} SluiceSimulationStats;

/* Since ABI 1.2. A body at the end of a value. Stands in an array, so its size is for good. */
typedef struct SluiceBodyState {
    float centre[3];
    float turn[4];              /* unit quaternion x, y, z, w from its axes to the world's */
    float velocity[3], spin[3]; /* m/s, rad/s */
    float force[3], torque[3];  /* of the fluid, mean over the value: N and N m about the centre, for 1000 kg/m^3 */
    uint32_t reserved[5];
} SluiceBodyState;

typedef struct SluiceBodies {
    uint32_t struct_size;
    uint32_t count; /* as many as SluiceSimulation had, in its order */
    uint64_t value; /* whose they are; 0: of the start */
    SluiceBodyState bodies[SLUICE_MAX_BODIES];
} SluiceBodies;

/* Since ABI 1.2. Where a body of SLUICE_BODY_DRIVEN is to be. */
typedef struct SluiceBodyTarget {
    uint32_t struct_size;
    float centre[3];
    float turn[4]; /* quaternion x, y, z, w of any length but 0 */
} SluiceBodyTarget;

/* Since ABI 1.3. A fluid as it is to begin anew; arrays as in SluiceSimulation. */
typedef struct SluiceStart {
    uint32_t struct_size;
    uint32_t particle_count; /* at most what set_simulation made room for (max_particles); 0 only with emitters */
    const float* position;
    const float* velocity;           /* may be NULL: at rest */
    const uint32_t* particle_fluids; /* since ABI 1.3: one for each, as in SluiceSimulation; NULL: all of the first */
} SluiceStart;

/* Since ABI 1.2. What may change while a fluid flows; all of it as in SluiceSimulation. */
typedef struct SluiceFlow {
    uint32_t struct_size;
    uint32_t iterations;
    float gravity[3];
    float viscosity, vorticity, tension, adhesion;
    uint32_t emitter_count; /* at most as many as SluiceSimulation had; those beyond are shut */
    SluiceEmitter emitters[SLUICE_MAX_EMITTERS];

    /* ABI 1.2 ends here. */
    uint32_t fluid_count; /* 0: all flow on as they did; else as many as SluiceSimulation had, and */
    SluiceFluidKind fluids[SLUICE_MAX_FLUIDS]; /* each with the density that it had */
} SluiceFlow;

/* ------------------------------------------------------------------------------------------------- statistics -- */

typedef struct SluicePassStats {
    char name[32];
    uint64_t nanoseconds;  /* GPU time between timestamps; 0 if the device has none */
    uint64_t elements;     /* particles for splats, pixels for image passes */
    uint64_t bytes;        /* compulsory traffic: each input read once, each output written once */
    uint32_t is_particles; /* 1: elements are particles, 0: pixels */
    uint32_t dispatches;   /* draws or dispatches that the pass recorded */
    uint64_t reserved[2];  /* zero */
} SluicePassStats;

typedef struct SluiceFrameStats {
    uint32_t struct_size;
    uint32_t pass_count;
    uint64_t frame;
    SluicePassStats passes[SLUICE_MAX_PASSES];
    uint64_t cpu_copy_bytes;      /* bytes of shared images that the CPU moved during this frame; 0 by contract */
    uint64_t upload_bytes;        /* particle data uploaded for this frame */
    uint32_t validation_messages; /* since create, when validation is on */
} SluiceFrameStats;

typedef struct SluiceCreateInfo {
    uint32_t struct_size;
    uint32_t width, height;     /* of the shared images; 1..SLUICE_MAX_EXTENT */
    uint32_t image_sets;        /* 1..SLUICE_MAX_IMAGE_SETS */
    uint32_t timeline;          /* SluiceTimelineKind requested */
    uint32_t validation;        /* 1: enable VK_LAYER_KHRONOS_validation with synchronisation validation */
    uint32_t outputs;           /* FLUID_* images to share; see SluiceSceneNeeds::outputs */
    uint32_t host_depth_format; /* SluiceFormat to force for HOST_DEPTH, or SLUICE_FORMAT_NONE to negotiate */
    SluiceHostCapabilities host;
} SluiceCreateInfo;

/* What create settled on. */
typedef struct SluiceRendererInfo {
    uint32_t struct_size;
    uint32_t timeline;                        /* SluiceTimelineKind in use */
    uint32_t formats[SLUICE_MAX_IMAGE_ROLES]; /* SluiceFormat per role, NONE where not shared */
    uint32_t host_depth_encoding;             /* SluiceDepthEncoding */
    uint32_t image_sets, width, height;
    SluiceRendererCapabilities capabilities;
} SluiceRendererInfo;

/* --------------------------------------------------------------------------------------------------- renderer -- */

typedef struct SluiceRenderer SluiceRenderer;

/* Receives one line of an explanation; the text is valid during the call. */
typedef void (*SluiceLineSink)(void* user, const char* line);

typedef struct SluiceRendererApi {
    uint32_t struct_size;
    uint32_t abi_version;
    const char* name; /* lives as long as the library is loaded, as does version */
    const char* version;

    /* Capabilities of the device that create would pick for these UUIDs. Creates nothing that outlives the call. */
    SluiceResult (*describe)(const SluiceHostServices* host, const SluiceCreateInfo* info,
                             SluiceRendererCapabilities* capabilities, SluiceError* error);

    /* The pass plan for these needs: one line per pass kept or left out, with the reason. Needs no device. */
    SluiceResult (*explain)(const SluiceSceneNeeds* needs, SluiceLineSink sink, void* sink_user, SluiceError* error);

    /* Create on the device with the host's UUIDs; prove the formats (canary), choose the timeline, share the images.
     * `host` must outlive the renderer. On failure *renderer is NULL and nothing is left behind. */
    SluiceResult (*create)(const SluiceHostServices* host, const SluiceCreateInfo* info, SluiceRenderer** renderer,
                           SluiceError* error);

    SluiceResult (*info)(SluiceRenderer* renderer, SluiceRendererInfo* info);

    /* Waits until no submitted frame is running, then replaces every shared image. Bad arguments (a size outside
     * 1..SLUICE_MAX_EXTENT, an unusable SluiceError) are refused before anything is done. On every other failure all
     * images have been retired and the renderer has none: submit_frame is refused until a resize has succeeded. */
    SluiceResult (*resize)(SluiceRenderer* renderer, uint32_t width, uint32_t height, SluiceError* error);

    /* Replace the particles for the frames submitted from now on; data is copied during the call. */
    SluiceResult (*set_particles)(SluiceRenderer* renderer, const SluiceParticles* particles, SluiceError* error);

    /* Replace the environment map; NULL returns to the procedural sky. */
    SluiceResult (*set_environment)(SluiceRenderer* renderer, const SluiceEnvironment* environment, SluiceError* error);

    /* Record and submit frame k. Returns without waiting for the device (FINISH excepted; and where simulation and
     * frames share one queue, a frame that draws a value waits until the last work of that value has been submitted,
     * and is refused after ten seconds). On failure the fluid images of that set are undefined and signal_value is
     * never signalled by this frame: the host composes without fluid. */
    SluiceResult (*submit_frame)(SluiceRenderer* renderer, const SluiceFrame* frame, SluiceError* error);

    /* Statistics of a submitted frame; SLUICE_NOT_READY until it finished. Kept for the last image_sets frames. */
    SluiceResult (*poll)(SluiceRenderer* renderer, uint64_t frame, SluiceFrameStats* stats);

    /* Any thread. The CPU ends of the timelines, used by BRIDGED and FINISH. */
    SluiceResult (*timeline_signal)(SluiceRenderer* renderer, uint64_t value); /* host-to-renderer, increasing */
    SluiceResult (*timeline_wait)(SluiceRenderer* renderer, uint64_t value, uint64_t timeout_ns); /* renderer-to-host */
    SluiceResult (*timeline_value)(SluiceRenderer* renderer, uint32_t direction, uint64_t* value);

    /* NATIVE: one fd per direction, value ignored. BINARY: one fd per (direction, value); for HOST_TO_RENDERER it must
     * be asked for before submit_frame waits for that value. The fd becomes the caller's. */
    SluiceResult (*timeline_export)(SluiceRenderer* renderer, uint32_t direction, uint64_t value, int32_t* fd,
                                    SluiceError* error);

    /* Canary round trip of one format at the given size, both directions; needs no renderer. */
    SluiceResult (*probe_format)(const SluiceHostServices* host, const SluiceCreateInfo* info, uint32_t format,
                                 uint32_t width, uint32_t height, SluiceError* error);

    /* Waits for the device, retires every image, frees everything. NULL is ignored. */
    void (*destroy)(SluiceRenderer* renderer);

    /* ABI 1.0 ends here. What follows lets a fluid flow on a thread and, where there is one, a queue of the renderer's
     * own. Its timeline starts at 0 and reaches v when the fluid of value v lies in an output slot on the device. A
     * ring of frames_in_flight + 1 slots is what frames are drawn from; no particle passes through the CPU. */

    /* Replace the simulation; NULL ends it. Waits for the frames in flight and the step under way. The fluid stands
     * still until simulate. On failure there is none. */
    SluiceResult (*set_simulation)(SluiceRenderer* renderer, const SluiceSimulation* simulation, SluiceError* error);

    /* Let the fluid flow for `seconds` more (0: not at all; below 1/1024 of longest_step: the fluid looks the
     * same and the next value has it) and call the result `value`, from 1 without gaps. Returns at once. The value
     * frames_in_flight + 1 before can be drawn no more; its slot is overwritten when the frames that draw it have
     * ended. A step that fails is told by simulation_stats and by one line of the log. */
    SluiceResult (*simulate)(SluiceRenderer* renderer, uint64_t value, double seconds, SluiceError* error);

    /* Any thread. Until the timeline has reached `value`, or SLUICE_TIMEOUT. */
    SluiceResult (*simulation_wait)(SluiceRenderer* renderer, uint64_t value, uint64_t timeout_ns);

    /* Any thread. INVALID_ARGUMENT without a simulation. */
    SluiceResult (*simulation_stats)(SluiceRenderer* renderer, SluiceSimulationStats* stats);

    /* ABI 1.1 ends here. */

    /* Any thread. The bodies at the end of `value`, one of those that can still be drawn; 0: of the last that has been
     * simulated. SLUICE_NOT_READY until it has. */
    SluiceResult (*simulation_bodies)(SluiceRenderer* renderer, uint64_t value, SluiceBodies* bodies);

    /* Where body number `body` (from 0), a driven one, is to be at the end of the value that simulate is called with
     * next: it goes there straight on, and pushes the fluid. Without a call it stays where it is. */
    SluiceResult (*set_body)(SluiceRenderer* renderer, uint32_t body, const SluiceBodyTarget* target,
                             SluiceError* error);

    /* How the fluid flows from the value on that simulate is called with next. What is wrong is refused, and all stays
     * as it was. A first tension or vorticity, and another axis of gravity, take the time of compiling passes. */
    SluiceResult (*set_flow)(SluiceRenderer* renderer, const SluiceFlow* flow, SluiceError* error);

    /* Since ABI 1.3. The value that simulate is called with next begins with these particles in place of those that
     * flow: at time 0, with bodies as they were given and with set_flow as it is; `seconds` of 0 shows them as they
     * are. What was asked for before comes first, and a simulation that has failed flows again. Returns at once; what
     * is wrong is refused by name, and all stays as it was. */
    SluiceResult (*reset_simulation)(SluiceRenderer* renderer, const SluiceStart* start, SluiceError* error);
} SluiceRendererApi;

/* The one exported symbol. Returns NULL when abi_version's major is not served. */
typedef const SluiceRendererApi* (*SluiceRendererEntry)(uint32_t abi_version);

#ifdef __cplusplus
}
#endif
/* NOLINTEND(modernize-*,performance-enum-size,bugprone-macro-parentheses) */
#endif
