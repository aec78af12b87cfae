/* SPDX-License-Identifier: MIT
 * A program without a window that is hard on whatever watches it. It draws into a pbuffer of EGL and prints a hash of
 * it after every swap.
 *
 * Usage: hard_target [WORD...]
 *   frames=N (6)   size=WxH (64x48)   quiet (no hashes)   bare (no bar over the scene)
 *   nodepth  (neither cleared nor tested)   sky  (nodepth, but with a test for the second draw of three)   named
 * (nodepth, but it is cleared by name)   fbo=N  (from frame N on, the scene is in a framebuffer of its own)   anew=N
 * (before frame N that one is deleted and made again)   menu=N  (in frames N and N + 1 the scene is in the window)
 * attributes  (the matrix mode comes back by glPopAttrib)   pushes  (one more than pops in each frame) framebuffer  (is
 * deleted while it is bound)   kill=N  (after frame N, the renderer's process, if there is one) thread  (draws in
 * another one, and destroys the context under it)   terminate  (the display in the middle, then again) default  (the
 * swap by dlsym(RTLD_DEFAULT))   epoxy  (binds framebuffers through libepoxy, from frame 3 on) pace=MS  (that long a
 * pause between frames)   signals  (how many threads would take a signal) wait (for all children at the end, of which
 * it has one)   die  (by SIGKILL at the end, after it named the renderer) */
#define _GNU_SOURCE
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/glext.h>
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static struct {
    int frames, width, height, kill, pace, fbo, anew, menu;
    int quiet, bare, attributes, pushes, no_depth, sky, named, framebuffer, thread, terminate, by_default, epoxy, wait,
        die, signals;
} options = {.frames = 6, .width = 64, .height = 48, .kill = -1, .fbo = -1, .anew = -1, .menu = -9};

static EGLDisplay display;
static EGLConfig config;
static EGLSurface surface;
static EGLContext context;

static void fail(const char* what) {
    (void)fprintf(stderr, "hard_target: no %s\n", what);
    exit(77);
}

/* ---- the renderer's process ---- */

/* Its command line is "sluice-renderer --WORD PID PLUGIN". */
static pid_t renderer(void) {
    DIR* folder = opendir("/proc");
    pid_t found = 0;
    for (const struct dirent* entry = NULL; found == 0 && folder != NULL && (entry = readdir(folder)) != NULL;) {
        char path[64], line[4096] = {0};
        const int number = atoi(entry->d_name);
        (void)snprintf(path, sizeof(path), "/proc/%d/cmdline", number);
        FILE* file = number > 0 ? fopen(path, "r") : NULL;
        const size_t length = file == NULL ? 0 : fread(line, 1, sizeof(line) - 1, file);
        if (file != NULL) {
            (void)fclose(file);
        }
        const char* const word = line + strlen(line) + 1;
        if (length > 0 && strstr(line, "sluice-renderer") != NULL && word < line + length) {
            const char* const of = word + strlen(word) + 1;
            found = of < line + length && atoi(of) == getpid() ? number : 0;
        }
    }
    (void)closedir(folder);
    return found;
}

/* ---- the picture ---- */

static void choose(void) {
    PFNEGLGETPLATFORMDISPLAYEXTPROC get =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress("eglGetPlatformDisplayEXT");
    display = get == NULL ? EGL_NO_DISPLAY : get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    const EGLint wanted[] = {
        EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_RED_SIZE, 8, EGL_DEPTH_SIZE, 24,
        EGL_NONE};
    EGLint count = 0;
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_API) ||
        !eglChooseConfig(display, wanted, &config, 1, &count) || count == 0) {
        fail("EGL config");
    }
}

static void make(void) {
    const EGLint size[] = {EGL_WIDTH, options.width, EGL_HEIGHT, options.height, EGL_NONE};
    surface = eglCreatePbufferSurface(display, config, size);
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, NULL);
    if (surface == EGL_NO_SURFACE || context == EGL_NO_CONTEXT) {
        fail("context");
    }
}

static void make_current(void) {
    if (!eglMakeCurrent(display, surface, surface, context)) {
        fail("current context");
    }
}

static void quad(void) {
    glBegin(GL_QUADS);
    for (int i = 0; i < 4; ++i) {
        glColor3f(0.8F, 0.2F * (float)i, 0.4F);
        glVertex3f(i % 3 == 0 ? -3.0F : 3.0F, i < 2 ? -2.0F : 2.0F, -6.0F);
    }
    glEnd();
}

static void scene(int frame) {
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glFrustum(-0.75, 0.75, -0.5, 0.5, 1.0, 50.0);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glTranslatef(0.0F, 0.0F, -0.05F * (float)frame);
    if (options.pushes) {
        glPushMatrix(); /* the stack overflows after 32 frames, which OpenGL takes no harm from */
    }
    if (!options.no_depth) {
        glEnable(GL_DEPTH_TEST);
    }
    quad();
    if (options.sky) {
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_ALWAYS); /* nobody has cleared it */
        quad();
        glDisable(GL_DEPTH_TEST);
    }
}

/* A framebuffer of our own, and what is drawn there. */
static GLuint own, own_picture, own_depth;

static void make_own(void) {
    if (own != 0) {
        glDeleteFramebuffers(1, &own);
        glDeleteTextures(1, &own_picture);
        glDeleteTextures(1, &own_depth);
    }
    const struct {
        GLuint* name;
        GLint format;
        GLenum of, as, at;
    } textures[] = {{&own_picture, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_COLOR_ATTACHMENT0},
                    {&own_depth, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, GL_DEPTH_ATTACHMENT}};
    glGenFramebuffers(1, &own);
    glBindFramebuffer(GL_FRAMEBUFFER, own);
    for (int i = 0; i < 2; ++i) {
        glGenTextures(1, textures[i].name);
        glBindTexture(GL_TEXTURE_2D, *textures[i].name);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexImage2D(GL_TEXTURE_2D, 0, textures[i].format, options.width, options.height, 0, textures[i].of,
                     textures[i].as, NULL);
        glFramebufferTexture2D(GL_FRAMEBUFFER, textures[i].at, GL_TEXTURE_2D, *textures[i].name, 0);
    }
    glBindTexture(GL_TEXTURE_2D, 0);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        fail("framebuffer");
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

static void show_own(void) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, own);
    glBlitFramebuffer(0, 0, options.width, options.height, 0, 0, options.width, options.height, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

static void bar(void) {
    if (options.attributes) {
        glMatrixMode(GL_PROJECTION);
        glPushAttrib(GL_TRANSFORM_BIT);
        glMatrixMode(GL_MODELVIEW);
        glPopAttrib();
    } else {
        glMatrixMode(GL_PROJECTION);
    }
    glLoadIdentity();
    glOrtho(0, 1, 0, 1, -1, 1);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glDisable(GL_DEPTH_TEST);
    glColor3f(1, 1, 0);
    glBegin(GL_QUADS);
    glVertex2f(0.1F, 0.05F);
    glVertex2f(0.9F, 0.05F);
    glVertex2f(0.9F, 0.15F);
    glVertex2f(0.1F, 0.15F);
    glEnd();
}

static void draw(int frame) {
    if (options.framebuffer) {
        GLuint name = 0;
        glGenFramebuffers(1, &name);
        glBindFramebuffer(GL_FRAMEBUFFER, name);
        glDeleteFramebuffers(1, &name);
    }
    if (options.epoxy && frame >= 3) {
        void** const bind = dlsym(dlopen("libepoxy.so.0", RTLD_NOW), "epoxy_glBindFramebuffer");
        void (*call)(GLenum, GLuint) = NULL;
        if (bind == NULL) {
            fail("libepoxy");
        }
        memcpy(&call, bind, sizeof(call));
        call(GL_FRAMEBUFFER, 0);
    }
    const int in_own = options.fbo >= 0 && frame >= options.fbo && frame != options.menu && frame != options.menu + 1;
    if (in_own) {
        if (own == 0 || frame == options.anew) {
            make_own();
        }
        glBindFramebuffer(GL_FRAMEBUFFER, own);
    }
    glViewport(0, 0, options.width, options.height);
    glClearColor(0.1F, 0.2F, 0.3F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT | (options.no_depth ? 0U : GL_DEPTH_BUFFER_BIT));
    if (options.named) {
        glClearNamedFramebufferfi(0, GL_DEPTH_STENCIL, 0, 1.0F, 0);
    }
    scene(frame);
    if (in_own) {
        show_own();
    }
    if (!options.bare) {
        bar();
    }
}

static void swap(void) {
    EGLBoolean (*call)(EGLDisplay, EGLSurface) = eglSwapBuffers;
    if (options.by_default) {
        void* const found = dlsym(RTLD_DEFAULT, "eglSwapBuffers");
        memcpy(&call, &found, sizeof(call));
    }
    (void)call(display, surface);
}

static void tell(int frame) {
    uint8_t* const pixels = malloc((size_t)options.width * (size_t)options.height * 4);
    if (pixels == NULL) {
        fail("memory");
    }
    glReadPixels(0, 0, options.width, options.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    uint64_t hash = 1469598103934665603ULL;
    for (int i = 0; i < options.width * options.height * 4; ++i) {
        hash = (hash ^ pixels[i]) * 1099511628211ULL;
    }
    free(pixels);
    if (!options.quiet) {
        (void)printf("%d %016llx\n", frame, (unsigned long long)hash);
        (void)fflush(stdout);
    }
}

static void show(int frame) {
    draw(frame);
    swap();
    tell(frame);
}

/* ---- what is hard ---- */

static atomic_int drawing;

static void* draw_elsewhere(void* nothing) {
    make_current();
    for (int frame = 0; frame < options.frames; ++frame) {
        show(frame);
        atomic_store(&drawing, frame + 1);
    }
    (void)eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    return nothing;
}

/* The context is destroyed while the other thread draws, and lives on until that thread lets go of it. */
static void destroy_under_a_thread(void) {
    pthread_t thread;
    if (pthread_create(&thread, NULL, draw_elsewhere, NULL) != 0) {
        fail("thread");
    }
    while (atomic_load(&drawing) < options.frames / 2) {
        (void)usleep(500);
    }
    (void)eglDestroyContext(display, context);
    (void)pthread_join(thread, NULL);
}

static atomic_int children_ended;

static void count_child(int number) {
    (void)number;
    atomic_fetch_add(&children_ended, 1);
}

static void wait_for_all(void) {
    struct sigaction action = {.sa_handler = count_child, .sa_flags = SA_RESTART};
    (void)sigaction(SIGCHLD, &action, NULL);
    const pid_t child = fork();
    if (child == 0) {
        _exit(3);
    }
    (void)usleep(20000);
    int waited = 0;
    for (pid_t found = 0; (found = waitpid(-1, NULL, child > 0 && waited > 0 ? WNOHANG : 0)) != -1;) {
        if (found == 0) {
            (void)printf("a child that is not ours\n");
            break;
        }
        ++waited;
    }
    (void)printf("children %d signals %d\n", waited, atomic_load(&children_ended));
}

/* SIGTERM is bit 14 of the mask. */
static int threads_open_to_signals(void) {
    DIR* folder = opendir("/proc/self/task");
    int open = 0;
    for (const struct dirent* entry = NULL; folder != NULL && (entry = readdir(folder)) != NULL;) {
        char path[300], line[256];
        (void)snprintf(path, sizeof(path), "/proc/self/task/%s/status", entry->d_name);
        FILE* file = fopen(path, "r");
        while (file != NULL && fgets(line, sizeof(line), file) != NULL) {
            unsigned long long blocked = 0;
            if (sscanf(line, "SigBlk: %llx", &blocked) == 1) {
                open += (blocked >> 14 & 1) == 0;
            }
        }
        if (file != NULL) {
            (void)fclose(file);
        }
    }
    (void)closedir(folder);
    return open;
}

static long number_of(const char* path, int entries) {
    long first = 0, second = 0, count = 0;
    if (entries) {
        DIR* folder = opendir(path);
        while (folder != NULL && readdir(folder) != NULL) {
            ++count;
        }
        (void)closedir(folder);
        return count;
    }
    FILE* file = fopen(path, "r");
    if (file == NULL || fscanf(file, "%ld %ld", &first, &second) != 2) {
        second = 0;
    }
    if (file != NULL) {
        (void)fclose(file);
    }
    return second * 4;
}

/* Descriptors and resident KiB of this process, and of the renderer's. */
static void measure(long* into) {
    char path[64];
    const pid_t other = renderer();
    into[0] = number_of("/proc/self/fd", 1);
    into[1] = number_of("/proc/self/statm", 0);
    (void)snprintf(path, sizeof(path), "/proc/%d/fd", other);
    into[2] = other > 0 ? number_of(path, 1) : 0;
    (void)snprintf(path, sizeof(path), "/proc/%d/statm", other);
    into[3] = other > 0 ? number_of(path, 0) : 0;
}

static void show_all(void) {
    long before[4] = {0}, after[4] = {0};
    make_current();
    for (int frame = 0; frame < options.frames; ++frame) {
        if (options.terminate && frame == options.frames / 2) {
            (void)eglTerminate(display);
            (void)eglReleaseThread();
            choose();
            make();
            make_current();
        }
        show(frame);
        (void)usleep(1000U * (unsigned)options.pace);
        if (frame == options.kill && renderer() != 0) {
            (void)kill(renderer(), SIGKILL);
            (void)usleep(100000);
        }
        if (frame == options.frames / 10) {
            measure(before);
        }
    }
    measure(after);
    if (options.quiet) {
        (void)printf("descriptors %ld kib %ld renderer: descriptors %ld kib %ld\n", after[0] - before[0],
                     after[1] - before[1], after[2] - before[2], after[3] - before[3]);
    }
}

static void read_options(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) {
        const char* word = argv[i];
        (void)sscanf(word, "frames=%d", &options.frames);
        (void)sscanf(word, "size=%dx%d", &options.width, &options.height);
        (void)sscanf(word, "kill=%d", &options.kill);
        (void)sscanf(word, "pace=%d", &options.pace);
        (void)sscanf(word, "fbo=%d", &options.fbo);
        (void)sscanf(word, "anew=%d", &options.anew);
        (void)sscanf(word, "menu=%d", &options.menu);
        options.sky |= strcmp(word, "sky") == 0;
        options.named |= strcmp(word, "named") == 0;
        options.quiet |= strcmp(word, "quiet") == 0;
        options.bare |= strcmp(word, "bare") == 0;
        options.attributes |= strcmp(word, "attributes") == 0;
        options.no_depth |= strcmp(word, "nodepth") == 0 || strcmp(word, "sky") == 0 || strcmp(word, "named") == 0;
        options.pushes |= strcmp(word, "pushes") == 0;
        options.framebuffer |= strcmp(word, "framebuffer") == 0;
        options.thread |= strcmp(word, "thread") == 0;
        options.terminate |= strcmp(word, "terminate") == 0;
        options.by_default |= strcmp(word, "default") == 0;
        options.epoxy |= strcmp(word, "epoxy") == 0;
        options.wait |= strcmp(word, "wait") == 0;
        options.signals |= strcmp(word, "signals") == 0;
        options.die |= strcmp(word, "die") == 0;
    }
}

int main(int argc, char** argv) {
    read_options(argc, argv);
    choose();
    make();
    if (options.thread) {
        destroy_under_a_thread();
    } else {
        show_all();
    }
    if (options.signals) {
        (void)printf("threads open to signals %d\n", threads_open_to_signals());
    }
    if (options.wait) {
        wait_for_all();
    }
    if (options.die) {
        (void)printf("renderer %d\n", renderer());
        (void)fflush(stdout);
        (void)raise(SIGKILL);
    }
    (void)fflush(stdout);
    return 0;
}
