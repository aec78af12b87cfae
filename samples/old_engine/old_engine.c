/*
 * old_engine.c - a courtyard with a basin, as an engine of 2004 draws it: OpenGL 1.x, GLUT, display lists, textures,
 * lights for each vertex, fog, a HUD in glOrtho. It knows nothing of Sluice; water.diff gives it water.
 *
 *   ./old_engine -frames 30 -shot out.ppm      draw 30 frames of 1/30 s each, write the last one, leave
 *
 * Keys: left and right walk round the basin, up and down go nearer and farther, p pauses, q or Escape leaves.
 */
#include <GL/glut.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#define PI 3.14159265358979f
#define TEXTURE_SIZE 64

static int win_width = 640, win_height = 480;
static int last_frame = 0;                 /* 0: run until somebody leaves */
static const char *shot_name = NULL;
static int frame = 0, paused = 0;
static float now = 0.0f; /* seconds */
static float eye_angle = 20.0f, eye_distance = 5.0f;
static GLuint floor_texture, stone_texture;
static GLuint room_list, basin_list, pillar_list;

static GLuint make_texture(int tiles, int r, int g, int b)
{
    static GLubyte texels[TEXTURE_SIZE][TEXTURE_SIZE][3];
    unsigned int noise = 1u;
    GLuint name;
    int x, y, cell;

    for (y = 0; y < TEXTURE_SIZE; y++) {
        for (x = 0; x < TEXTURE_SIZE; x++) {
            noise = noise * 1103515245u + 12345u;
            cell = (x * tiles / TEXTURE_SIZE + y * tiles / TEXTURE_SIZE) & 1;
            cell = (cell ? 255 : 190) - (int)((noise >> 16) % 24u);
            texels[y][x][0] = (GLubyte)(r * cell / 255);
            texels[y][x][1] = (GLubyte)(g * cell / 255);
            texels[y][x][2] = (GLubyte)(b * cell / 255);
        }
    }
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    gluBuild2DMipmaps(GL_TEXTURE_2D, GL_RGB, TEXTURE_SIZE, TEXTURE_SIZE, GL_RGB, GL_UNSIGNED_BYTE, texels);
    return name;
}

/* An axis-aligned box whose texture repeats once a metre. */
static void box(float x0, float y0, float z0, float x1, float y1, float z1)
{
    const float lo[3] = { x0, y0, z0 }, hi[3] = { x1, y1, z1 };
    int axis, side, corner;

    glBegin(GL_QUADS);
    for (axis = 0; axis < 3; axis++) {
        for (side = 0; side < 2; side++) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            float n[3] = { 0.0f, 0.0f, 0.0f }, p[3];
            n[axis] = side ? 1.0f : -1.0f;
            glNormal3fv(n);
            for (corner = 0; corner < 4; corner++) {
                const int c = side ? corner : 3 - corner;
                p[axis] = side ? hi[axis] : lo[axis];
                p[u] = (c == 1 || c == 2) ? hi[u] : lo[u];
                p[v] = (c >= 2) ? hi[v] : lo[v];
                glTexCoord2f(p[u], p[v]);
                glVertex3fv(p);
            }
        }
    }
    glEnd();
}

static void build_lists(void)
{
    GLUquadric *quadric = gluNewQuadric();
    int i, j;

    room_list = glGenLists(1);
    glNewList(room_list, GL_COMPILE);
    glBindTexture(GL_TEXTURE_2D, floor_texture);
    glNormal3f(0.0f, 1.0f, 0.0f);
    glBegin(GL_QUADS);                     /* in small tiles: lights are per vertex */
    for (i = -8; i < 8; i++) {
        for (j = -8; j < 8; j++) {
            glTexCoord2i(i, j);         glVertex3i(i, 0, j);
            glTexCoord2i(i, j + 1);     glVertex3i(i, 0, j + 1);
            glTexCoord2i(i + 1, j + 1); glVertex3i(i + 1, 0, j + 1);
            glTexCoord2i(i + 1, j);     glVertex3i(i + 1, 0, j);
        }
    }
    glEnd();
    glBindTexture(GL_TEXTURE_2D, stone_texture);
    box(-8.0f, 0.0f, -8.5f, 8.0f, 2.5f, -8.0f);
    box(-8.0f, 0.0f, 8.0f, 8.0f, 2.5f, 8.5f);
    box(-8.5f, 0.0f, -8.0f, -8.0f, 2.5f, 8.0f);
    box(8.0f, 0.0f, -8.0f, 8.5f, 2.5f, 8.0f);
    glEndList();

    basin_list = glGenLists(1);            /* 2 m by 2 m inside, walls of 0.2 m */
    glNewList(basin_list, GL_COMPILE);
    glBindTexture(GL_TEXTURE_2D, stone_texture);
    box(-1.2f, 0.0f, -1.2f, -1.0f, 0.6f, 1.2f);
    box(1.0f, 0.0f, -1.2f, 1.2f, 0.6f, 1.2f);
    box(-1.0f, 0.0f, -1.2f, 1.0f, 0.6f, -1.0f);
    box(-1.0f, 0.0f, 1.0f, 1.0f, 0.6f, 1.2f);
    glEndList();

    pillar_list = glGenLists(1);
    gluQuadricTexture(quadric, GL_TRUE);
    glNewList(pillar_list, GL_COMPILE);
    glPushMatrix();
    glRotatef(-90.0f, 1.0f, 0.0f, 0.0f);
    gluCylinder(quadric, 0.25, 0.2, 2.5, 20, 6);
    glPopMatrix();
    glEndList();
    gluDeleteQuadric(quadric);
}

static void draw_world(void)
{
    static const float sun[4] = { 0.4f, 0.8f, 0.3f, 0.0f };
    static const float at[4][2] = { { 2.2f, 2.2f }, { -2.2f, 2.2f }, { -2.2f, -2.2f }, { 2.2f, -2.2f } };
    int i;

    glLightfv(GL_LIGHT0, GL_POSITION, sun);
    glPushAttrib(GL_ENABLE_BIT);
    glEnable(GL_LIGHTING);
    glEnable(GL_TEXTURE_2D);
    glEnable(GL_FOG);
    glColor3f(1.0f, 1.0f, 1.0f);
    glCallList(room_list);
    glCallList(basin_list);
    for (i = 0; i < 4; i++) {
        glPushMatrix();
        glTranslatef(at[i][0], 0.0f, at[i][1]);
        glCallList(pillar_list);
        glPopMatrix();
    }
    glDisable(GL_TEXTURE_2D);
    glColor3f(0.85f, 0.55f, 0.2f);         /* the teapot that no demo went without */
    glPushMatrix();
    glTranslatef(0.0f, 1.6f, -2.4f);
    glRotatef(now * 40.0f, 0.0f, 1.0f, 0.0f);
    glFrontFace(GL_CW);
    glutSolidTeapot(0.4);
    glFrontFace(GL_CCW);
    glPopMatrix();
    glPopAttrib();
}

static void text(int x, int y, const char *s)
{
    glRasterPos2i(x, y);
    for (; *s; s++)
        glutBitmapCharacter(GLUT_BITMAP_8_BY_13, *s);
}

static void draw_hud(void)
{
    char line[64];
    const int cx = win_width / 2, cy = win_height / 2;

    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glOrtho(0.0, win_width, 0.0, win_height, -1.0, 1.0);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glDisable(GL_DEPTH_TEST);
    glColor3f(0.1f, 0.1f, 0.15f);
    glRecti(8, 8, 208, 44);
    glColor3f(0.8f, 0.15f, 0.1f);
    glRecti(12, 12, 12 + 140, 22);
    glColor3f(1.0f, 0.9f, 0.3f);
    sprintf(line, "HEALTH 70   FRAME %d", frame);
    text(12, 28, line);
    glBegin(GL_LINES);                     /* the crosshair, over the water */
    glVertex2i(cx - 8, cy); glVertex2i(cx + 9, cy);
    glVertex2i(cx, cy - 8); glVertex2i(cx, cy + 9);
    glEnd();
    glEnable(GL_DEPTH_TEST);
}

static void write_shot(void)
{
    GLubyte *pixels = malloc((size_t)win_width * (size_t)win_height * 3);
    FILE *file = fopen(shot_name, "wb");
    int y;

    if (!pixels || !file)
        exit(1);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, win_width, win_height, GL_RGB, GL_UNSIGNED_BYTE, pixels);
    fprintf(file, "P6\n%d %d\n255\n", win_width, win_height);
    for (y = win_height - 1; y >= 0; y--)
        fwrite(pixels + (size_t)y * (size_t)win_width * 3, 3, (size_t)win_width, file);
    fclose(file);
    free(pixels);
}

static void leave(void)
{
    exit(0);
}

static void display(void)
{
    const float a = eye_angle * PI / 180.0f;

    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    gluPerspective(50.0, (double)win_width / win_height, 0.1, 60.0);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    gluLookAt(sin(a) * eye_distance, 2.4, cos(a) * eye_distance, 0.0, 0.5, 0.0, 0.0, 1.0, 0.0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    draw_world();
    draw_hud();
    frame++;
    if (last_frame && frame >= last_frame) {
        if (shot_name)
            write_shot();
        leave();
    }
    glutSwapBuffers();
}

static void idle(void)
{
    if (!paused)
        now = last_frame ? (float)(frame + 1) / 30.0f : (float)glutGet(GLUT_ELAPSED_TIME) / 1000.0f;
    glutPostRedisplay();
}

static void reshape(int width, int height)
{
    win_width = width;
    win_height = height > 0 ? height : 1;
    glViewport(0, 0, win_width, win_height);
}

static void key(unsigned char c, int x, int y)
{
    (void)x, (void)y;
    if (c == 'p')
        paused = !paused;
    if (c == 'q' || c == 27)
        leave();
}

static void special(int c, int x, int y)
{
    (void)x, (void)y;
    eye_angle += c == GLUT_KEY_LEFT ? -5.0f : c == GLUT_KEY_RIGHT ? 5.0f : 0.0f;
    eye_distance += c == GLUT_KEY_UP && eye_distance > 2.5f ? -0.25f : c == GLUT_KEY_DOWN ? 0.25f : 0.0f;
}

static void init(void)
{
    static const float fog[4] = { 0.55f, 0.65f, 0.75f, 1.0f };
    static const float ambient[4] = { 0.35f, 0.37f, 0.42f, 1.0f };

    glClearColor(fog[0], fog[1], fog[2], fog[3]);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glEnable(GL_LIGHT0);
    glEnable(GL_COLOR_MATERIAL);
    glLightModelfv(GL_LIGHT_MODEL_AMBIENT, ambient);
    glFogi(GL_FOG_MODE, GL_EXP2);
    glFogf(GL_FOG_DENSITY, 0.05f);
    glFogfv(GL_FOG_COLOR, fog);
    floor_texture = make_texture(2, 150, 140, 120);
    stone_texture = make_texture(8, 170, 170, 165);
    build_lists();
}

int main(int argc, char **argv)
{
    int i;

    glutInit(&argc, argv);
    for (i = 1; i + 1 < argc; i += 2) {
        last_frame = strcmp(argv[i], "-frames") == 0 ? atoi(argv[i + 1]) : last_frame;
        shot_name = strcmp(argv[i], "-shot") == 0 ? argv[i + 1] : shot_name;
    }
    glutInitWindowSize(win_width, win_height);
    glutInitDisplayMode(GLUT_RGB | GLUT_DOUBLE | GLUT_DEPTH);
    glutCreateWindow("Old engine");
    init();
    glutDisplayFunc(display);
    glutReshapeFunc(reshape);
    glutKeyboardFunc(key);
    glutSpecialFunc(special);
    glutIdleFunc(idle);
    glutMainLoop();
    return 0;
}
