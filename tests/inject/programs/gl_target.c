/* SPDX-License-Identifier: MIT
 * A small program of the kind that `sluice inject` is for: it knows nothing of Sluice. It draws a room in perspective
 * and a bar over it in orthographic projection, and prints a hash of what stands in its window after every frame.
 *
 * Usage: gl_target API ROUTE [WORD...]
 *   API    glx, egl          ROUTE  symbol, proc (GetProcAddress), dlsym
 *   frames=N (4)  depth=N (24)  samples=N (0)  core  (a core profile with a shader of its own)  es  (OpenGL ES 3)
 *   ubo  (the matrix in a uniform block, written by a call and through a mapping in turns)
 *   reversed  (core: depth from 0 to 1, 1 at the near plane)
 *   minimise  (unmapped for the third of the frames in the middle)
 *   resize  (in the middle)  destroy  (the context in the middle of a frame, then another one)  second  (another
 * context in another window, turn by turn)  raise=N (ends by that signal)  code=N (exits with it)  quiet (no hash)
 * child=COMMAND bar=HOW (the bar is drawn with rect, rectv, pixels or bitmap) */
#define _GNU_SOURCE
#define GL_GLEXT_PROTOTYPES
#define USE_X11
#include <EGL/egl.h>
#include <GL/gl.h>
#include <GL/glx.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <dirent.h>
#include <dlfcn.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void (*Function)(void);

static struct {
    int egl, core, es, ubo, reversed, resize, minimise, destroy, second, quiet;
    int frames, depth, samples, raise, code;
    const char *route, *child, *bar;
} options = {.frames = 4, .depth = 24, .route = "symbol", .bar = "array"};

static Display* display;
static int width = 96, height = 64;

/* ---- the ways of asking for a function ---- */

static Function from_address(void* address) {
    Function function = NULL;
    memcpy(&function, &address, sizeof(function));
    return function;
}

static Function look_up(const char* name, Function symbol) {
    if (strcmp(options.route, "proc") == 0) {
        return options.egl ? (Function)eglGetProcAddress(name) : (Function)glXGetProcAddressARB((const GLubyte*)name);
    }
    if (strcmp(options.route, "dlsym") == 0) {
        void* library = dlopen(options.egl && strncmp(name, "egl", 3) == 0 ? "libEGL.so.1" : "libGL.so.1", RTLD_NOW);
        return from_address(dlsym(library, name));
    }
    return symbol;
}
#define LOOK_UP(name) ((__typeof__(&name))look_up(#name, (Function)name))

/* ---- windows and contexts ---- */

typedef struct Screen_ {
    Window window;
    XVisualInfo* visual;
    GLXFBConfig glx_config;
    GLXContext glx;
    EGLDisplay egl_display;
    EGLConfig egl_config;
    EGLSurface surface;
    EGLContext egl;
} Screen_;

static void fail(const char* what) {
    (void)fprintf(stderr, "gl_target: no %s\n", what);
    exit(77);
}

static void choose_glx(Screen_* s) {
    const int wanted[] = {GLX_DOUBLEBUFFER,
                          True,
                          GLX_RED_SIZE,
                          8,
                          GLX_DEPTH_SIZE,
                          options.depth,
                          GLX_STENCIL_SIZE,
                          options.depth == 24 ? 8 : 0,
                          GLX_SAMPLES,
                          options.samples,
                          None};
    int count = 0;
    GLXFBConfig* configs = glXChooseFBConfig(display, DefaultScreen(display), wanted, &count);
    if (configs == NULL || count == 0) {
        fail("GLX config");
    }
    s->glx_config = configs[0];
    s->visual = glXGetVisualFromFBConfig(display, configs[0]);
    (void)XFree(configs);
}

static void choose_egl(Screen_* s) {
    s->egl_display = eglGetDisplay((EGLNativeDisplayType)display);
    const EGLint wanted[] = {EGL_SURFACE_TYPE,
                             EGL_WINDOW_BIT,
                             EGL_RENDERABLE_TYPE,
                             options.es ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT,
                             EGL_RED_SIZE,
                             8,
                             EGL_DEPTH_SIZE,
                             options.depth,
                             EGL_SAMPLES,
                             options.samples,
                             EGL_NONE};
    EGLint count = 0;
    EGLint id = 0;
    if (!eglInitialize(s->egl_display, NULL, NULL) || !eglBindAPI(options.es ? EGL_OPENGL_ES_API : EGL_OPENGL_API) ||
        !eglChooseConfig(s->egl_display, wanted, &s->egl_config, 1, &count) || count == 0 ||
        !eglGetConfigAttrib(s->egl_display, s->egl_config, EGL_NATIVE_VISUAL_ID, &id)) {
        fail("EGL config");
    }
    XVisualInfo like = {.visualid = (VisualID)id};
    s->visual = XGetVisualInfo(display, VisualIDMask, &like, &count);
}

static void make_context(Screen_* s) {
    const int profile = options.es ? GLX_CONTEXT_ES2_PROFILE_BIT_EXT : GLX_CONTEXT_CORE_PROFILE_BIT_ARB;
    const int minor = options.es ? 0 : 3;
    const int core[] = {GLX_CONTEXT_MAJOR_VERSION_ARB,
                        3,
                        GLX_CONTEXT_MINOR_VERSION_ARB,
                        minor,
                        GLX_CONTEXT_PROFILE_MASK_ARB,
                        profile,
                        None};
    const EGLint egl_core[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, minor, EGL_NONE};
    if (options.egl) {
        s->egl = eglCreateContext(s->egl_display, s->egl_config, EGL_NO_CONTEXT, options.core ? egl_core : NULL);
        (void)LOOK_UP(eglMakeCurrent)(s->egl_display, s->surface, s->surface, s->egl);
    } else {
        PFNGLXCREATECONTEXTATTRIBSARBPROC make =
            (PFNGLXCREATECONTEXTATTRIBSARBPROC)glXGetProcAddressARB((const GLubyte*)"glXCreateContextAttribsARB");
        s->glx = options.core ? make(display, s->glx_config, NULL, True, core)
                              : glXCreateNewContext(display, s->glx_config, GLX_RGBA_TYPE, NULL, True);
        (void)LOOK_UP(glXMakeCurrent)(display, s->window, s->glx);
    }
}

static void make_screen(Screen_* s, int x) {
    options.egl ? choose_egl(s) : choose_glx(s);
    if (s->visual == NULL) {
        fail("visual");
    }
    Window root = DefaultRootWindow(display);
    XSetWindowAttributes attributes = {.override_redirect = True,
                                       .colormap = XCreateColormap(display, root, s->visual->visual, AllocNone)};
    s->window = XCreateWindow(display, root, x, 0, (unsigned)width, (unsigned)height, 0, s->visual->depth, InputOutput,
                              s->visual->visual, CWOverrideRedirect | CWColormap | CWBorderPixel, &attributes);
    (void)XMapRaised(display, s->window);
    (void)XSync(display, False);
    if (options.egl) {
        s->surface = eglCreateWindowSurface(s->egl_display, s->egl_config, s->window, NULL);
    }
    make_context(s);
}

static void make_current(Screen_* s) {
    if (options.egl) {
        (void)LOOK_UP(eglMakeCurrent)(s->egl_display, s->surface, s->surface, s->egl);
    } else {
        (void)LOOK_UP(glXMakeCurrent)(display, s->window, s->glx);
    }
}

static void destroy_context(Screen_* s) {
    if (options.egl) {
        (void)LOOK_UP(eglDestroyContext)(s->egl_display, s->egl);
        (void)LOOK_UP(eglMakeCurrent)(s->egl_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    } else {
        LOOK_UP(glXDestroyContext)(display, s->glx);
        (void)LOOK_UP(glXMakeCurrent)(display, None, NULL);
    }
}

static void swap(Screen_* s) {
    if (options.egl) {
        (void)LOOK_UP(eglSwapBuffers)(s->egl_display, s->surface);
    } else {
        LOOK_UP(glXSwapBuffers)(display, s->window);
    }
}

/* ---- the picture ---- */

static const float room[][3] = {{-1, -1, -6}, {1, -1, -6}, {1, 1, -6},  {-1, 1, -6},
                                {-2, -1, -2}, {2, -1, -2}, {2, -1, -6}, {-2, -1, -6}};

static void draw_bar(void) {
    static const GLubyte picture[64] = {255, 255, 0, 255, 255, 255, 0, 255};
    static const GLint low[] = {0, 0}, high[] = {1, 1};
    glRasterPos2f(0.1F, 0.05F);
    if (strcmp(options.bar, "rect") == 0) {
        LOOK_UP(glRectf)(0.1F, 0.05F, 0.9F, 0.15F);
    } else if (strcmp(options.bar, "rectv") == 0) {
        LOOK_UP(glRectiv)(low, high);
    } else if (strcmp(options.bar, "pixels") == 0) {
        LOOK_UP(glDrawPixels)(4, 4, GL_RGBA, GL_UNSIGNED_BYTE, picture);
    } else if (strcmp(options.bar, "bitmap") == 0) {
        LOOK_UP(glBitmap)(8, 8, 0, 0, 8, 0, picture);
    } else {
        const float bar[] = {0.1F, 0.05F, 0.9F, 0.05F, 0.9F, 0.15F, 0.1F, 0.15F};
        glEnableClientState(GL_VERTEX_ARRAY);
        glVertexPointer(2, GL_FLOAT, 0, bar);
        LOOK_UP(glDrawArrays)(GL_QUADS, 0, 4);
        glDisableClientState(GL_VERTEX_ARRAY);
    }
}

static void draw_fixed(int frame) {
    LOOK_UP(glMatrixMode)(GL_PROJECTION);
    LOOK_UP(glLoadIdentity)();
    LOOK_UP(glFrustum)(-0.75, 0.75, -0.5, 0.5, 1.0, 50.0);
    LOOK_UP(glMatrixMode)(GL_MODELVIEW);
    LOOK_UP(glLoadIdentity)();
    LOOK_UP(glTranslatef)(0.0F, 0.0F, -0.1F * (float)frame);
    glEnable(GL_DEPTH_TEST);
    LOOK_UP(glBegin)(GL_QUADS);
    for (size_t i = 0; i < sizeof(room) / sizeof(room[0]); ++i) {
        glColor3f(i < 4 ? 0.8F : 0.2F, 0.1F * (float)(i % 4), 0.4F);
        glVertex3fv(room[i]);
    }
    LOOK_UP(glEnd)();
    if (options.destroy && frame == options.frames / 2) {
        return; /* the rest of this frame is never drawn */
    }
    LOOK_UP(glMatrixMode)(GL_PROJECTION);
    LOOK_UP(glLoadIdentity)();
    LOOK_UP(glOrtho)(0, 1, 0, 1, -1, 1);
    LOOK_UP(glMatrixMode)(GL_MODELVIEW);
    LOOK_UP(glLoadIdentity)();
    glDisable(GL_DEPTH_TEST);
    glColor3f(1, 1, 0);
    draw_bar();
}

static GLuint shader(GLenum kind, const char* text) {
    const GLuint name = glCreateShader(kind);
    const char* const lines[] = {options.es ? "#version 300 es\nprecision highp float;\n" : "#version 330\n", text};
    glShaderSource(name, 2, lines, NULL);
    glCompileShader(name);
    return name;
}

static GLuint program(const char* vertex) {
    const GLuint name = glCreateProgram();
    glAttachShader(name, shader(GL_VERTEX_SHADER, vertex));
    glAttachShader(name,
                   shader(GL_FRAGMENT_SHADER, "out vec4 colour;in vec3 tint;void main(){colour=vec4(tint,1.0);}"));
    glBindAttribLocation(name, 0, "at");
    glLinkProgram(name);
    return name;
}

/* Of a block that has 16 bytes of something else before its matrix, 256 bytes into its buffer. */
static void write_block(GLuint block, int frame, const float matrix[16]) {
    glBindBuffer(GL_UNIFORM_BUFFER, block);
    if (frame % 2 == 0) {
        LOOK_UP(glBufferSubData)(GL_UNIFORM_BUFFER, 272, 64, matrix);
    } else {
        void* to = glMapBufferRange(GL_UNIFORM_BUFFER, 272, 64, GL_MAP_WRITE_BIT);
        memcpy(to, matrix, 64);
        (void)LOOK_UP(glUnmapBuffer)(GL_UNIFORM_BUFFER);
    }
    LOOK_UP(glBindBufferRange)(GL_UNIFORM_BUFFER, 3, block, 256, 80);
}

static void draw_core(int frame) {
    static GLuint world, overlay, array, buffer, block;
    if (world == 0) {
        world = program(options.ubo ? "layout(std140) uniform Scene{vec4 other;mat4 mvp;};in vec3 at;out vec3 tint;"
                                      "void main(){gl_Position=mvp*vec4(at,1.0);tint=fract(at*0.3+other.xyz);}"
                                    : "uniform mat4 mvp;in vec3 at;out vec3 tint;"
                                      "void main(){gl_Position=mvp*vec4(at,1.0);tint=fract(at*0.3);}");
        overlay = program(
            "in vec3 at;out vec3 tint;"
            "void main(){gl_Position=vec4(at.xy*0.3-0.5,0.0,1.0);tint=vec3(1.0,1.0,0.0);}");
        glGenVertexArrays(1, &array);
        glGenBuffers(1, &buffer);
        glGenBuffers(1, &block);
        if (options.ubo) {
            glUniformBlockBinding(world, glGetUniformBlockIndex(world, "Scene"), 3);
            static const char nothing[512];
            glBindBuffer(GL_UNIFORM_BUFFER, block);
            glBufferData(GL_UNIFORM_BUFFER, sizeof(nothing), nothing, GL_STREAM_DRAW);
        }
    }
    const float z = -0.1F * (float)frame;
    /* glFrustum(-0.75, 0.75, -0.5, 0.5, 1, 50) times a translation by z. */
    const float a = options.reversed ? 1.0F / 49.0F : -51.0F / 49.0F;
    const float b = options.reversed ? 50.0F / 49.0F : -100.0F / 49.0F;
    const float mvp[16] = {1 / 0.75F, 0, 0, 0, 0, 2, 0, 0, 0, 0, a, -1, 0, 0, a * z + b, -z};
    glBindVertexArray(array);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, sizeof(room), room, GL_STATIC_DRAW);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, NULL);
    glEnableVertexAttribArray(0);
    glEnable(GL_DEPTH_TEST);
    LOOK_UP(glUseProgram)(world);
    if (options.ubo) {
        write_block(block, frame, mvp);
    } else {
        LOOK_UP(glUniformMatrix4fv)(glGetUniformLocation(world, "mvp"), 1, GL_FALSE, mvp);
    }
    LOOK_UP(glDrawArrays)(GL_TRIANGLE_FAN, 0, 4);
    LOOK_UP(glDrawArrays)(GL_TRIANGLE_FAN, 4, 4);
    glDisable(GL_DEPTH_TEST);
    LOOK_UP(glUseProgram)(overlay);
    LOOK_UP(glDrawArrays)(GL_TRIANGLE_FAN, 0, 4);
    LOOK_UP(glUseProgram)(0);
}

static void draw(int frame) {
    glViewport(0, 0, width, height);
    glClearColor(0.1F, 0.2F, 0.3F, 1.0F);
    if (options.reversed) {
        glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
        glDepthFunc(GL_GREATER);
        glClearDepth(0.0);
    }
    LOOK_UP(glClear)(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    options.core ? draw_core(frame) : draw_fixed(frame);
}

/* ---- what is told ---- */

static void tell(const Screen_* s, int frame) {
    glFinish();
    (void)XSync(display, False);
    XImage* image = XGetImage(display, s->window, 0, 0, (unsigned)width, (unsigned)height, AllPlanes, ZPixmap);
    if (image == NULL) {
        fail("picture");
    }
    uint64_t hash = 1469598103934665603ULL;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            hash = (hash ^ (XGetPixel(image, x, y) & 0xFFFFFFU)) * 1099511628211ULL;
        }
    }
    (void)printf("%d %dx%d %016llx error %x\n", frame, width, height, (unsigned long long)hash, LOOK_UP(glGetError)());
    (void)XDestroyImage(image);
}

static int open_descriptors(void) {
    int count = 0;
    DIR* folder = opendir("/proc/self/fd");
    while (folder != NULL && readdir(folder) != NULL) {
        ++count;
    }
    (void)closedir(folder);
    return count;
}

static long resident_kib(void) {
    long pages = 0, resident = 0;
    FILE* file = fopen("/proc/self/statm", "r");
    if (file == NULL || fscanf(file, "%ld %ld", &pages, &resident) != 2) {
        fail("statm");
    }
    (void)fclose(file);
    return resident * 4;
}

static void read_options(int argc, char** argv) {
    options.egl = argc > 1 && strcmp(argv[1], "egl") == 0;
    options.route = argc > 2 ? argv[2] : "symbol";
    for (int i = 3; i < argc; ++i) {
        const char* word = argv[i];
        (void)sscanf(word, "frames=%d", &options.frames);
        (void)sscanf(word, "depth=%d", &options.depth);
        (void)sscanf(word, "samples=%d", &options.samples);
        (void)sscanf(word, "raise=%d", &options.raise);
        (void)sscanf(word, "code=%d", &options.code);
        options.bar = strncmp(word, "bar=", 4) == 0 ? word + 4 : options.bar;
        options.es |= strcmp(word, "es") == 0;
        options.ubo |= strcmp(word, "ubo") == 0;
        options.reversed |= strcmp(word, "reversed") == 0;
        options.core |= strcmp(word, "core") == 0 || options.es;
        options.resize |= strcmp(word, "resize") == 0;
        options.minimise |= strcmp(word, "minimise") == 0;
        options.destroy |= strcmp(word, "destroy") == 0;
        options.second |= strcmp(word, "second") == 0;
        options.quiet |= strcmp(word, "quiet") == 0;
        options.child = strncmp(word, "child=", 6) == 0 ? word + 6 : options.child;
    }
}

int main(int argc, char** argv) {
    read_options(argc, argv);
    display = XOpenDisplay(NULL);
    if (display == NULL) {
        fail("display");
    }
    Screen_ first = {0}, other = {0};
    if (options.second) {
        make_screen(&other, 200);
    }
    make_screen(&first, 0);
    int descriptors = 0;
    long resident = 0;
    for (int frame = 0; frame < options.frames; ++frame) {
        if (options.resize && frame == options.frames / 2) {
            width = 131;
            height = 77;
            (void)XResizeWindow(display, first.window, (unsigned)width, (unsigned)height);
            if (options.second) {
                (void)XResizeWindow(display, other.window, (unsigned)width, (unsigned)height);
            }
            (void)XSync(display, False);
        }
        const int hidden = options.minimise && frame >= options.frames / 3 && frame < options.frames * 2 / 3;
        if (options.minimise) {
            (void)(hidden ? XUnmapWindow(display, first.window) : XMapRaised(display, first.window));
            (void)XSync(display, False);
        }
        Screen_* const to = options.second && frame % 2 == 1 ? &other : &first;
        if (options.second) {
            make_current(to);
        }
        draw(frame);
        if (options.destroy && frame == options.frames / 2) {
            destroy_context(to);
            make_context(to);
            continue;
        }
        if (frame == 2) {
            glEnable(0xFFFF); /* an error that the program asks for after the swap, and must find */
        }
        swap(to);
        if (!options.quiet && !hidden) { /* X has no front buffer of a window that is not there */
            tell(to, frame);
        }
        if (frame == options.frames / 10) {
            descriptors = open_descriptors();
            resident = resident_kib();
        }
    }
    if (options.quiet) {
        (void)printf("descriptors %d kib %ld\n", open_descriptors() - descriptors, resident_kib() - resident);
    }
    (void)fflush(stdout);
    if (options.child != NULL) {
        (void)!system(options.child);
    }
    if (options.raise != 0) {
        (void)raise(options.raise);
    }
    return options.code;
}
