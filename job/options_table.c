/* The options of a render, in the order of --help. */
#include "job/options.h"

#define FIELD(name) .offset = offsetof(job_options, name)

static const option_choice estimators[] = {
    {"bsdf", KILN_ESTIMATOR_BSDF},   {"nee", KILN_ESTIMATOR_NEE},         {"mis", KILN_ESTIMATOR_MIS},
    {"naive", KILN_ESTIMATOR_NAIVE}, {"doubled", KILN_ESTIMATOR_DOUBLED}, {NULL, 0}};
static const option_choice samplers[] = {
    {"sobol", KILN_SAMPLER_SOBOL}, {"independent", KILN_SAMPLER_INDEPENDENT}, {NULL, 0}};
static const option_choice light_samplings[] = {
    {"tree", KILN_LIGHTS_TREE}, {"power", KILN_LIGHTS_POWER}, {"uniform", KILN_LIGHTS_UNIFORM}, {NULL, 0}};
static const option_choice texture_filters[] = {
    {"bilinear", KILN_TEXTURES_BILINEAR}, {"mip", KILN_TEXTURES_MIP}, {NULL, 0}};
static const option_choice adaptivities[] = {
    {"auto", KILN_ADAPTIVE_AUTO}, {"on", KILN_ADAPTIVE_ON}, {"off", KILN_ADAPTIVE_OFF}, {NULL, 0}};
static const option_choice schemes[] = {{"auto", KILN_SCHEME_AUTO},
                                        {"catmull-clark", KILN_SCHEME_CATMULL_CLARK},
                                        {"loop", KILN_SCHEME_LOOP},
                                        {"bilinear", KILN_SCHEME_BILINEAR},
                                        {NULL, 0}};

static const option_choice metrics[] = {{"relmse", KILN_METRIC_RELMSE},
                                        {"mse", KILN_METRIC_MSE},
                                        {"mae", KILN_METRIC_MAE},
                                        {"flip", KILN_METRIC_FLIP},
                                        {NULL, 0}};

static const char picture[] = "Picture", quality[] = "When it ends", estimator[] = "Estimator", camera[] = "Camera",
                  light[] = "Light", surface[] = "Surfaces", color[] = "Colour", machine[] = "Machine",
                  measure[] = "Measure", compare[] = "Pictures", study[] = "Study";

/* In the order of kiln/film.h. */
#define AOV_NAMES                                                                                                      \
    "alpha, albedo, normal, depth, position, uv, object, material, samples, error; emission, direct, indirect; "        \
    "lobe:NAME (emission, diffuse, clearcoat, sheen, translucency, specular, transmission); lightgroup:NAME (a light "   \
    "or an emitting material, or environment); cryptomatte, cryptomatte:NAME (object, material, asset)"

static const option_row rows[] = {
    {"output", 'o', "FILE", picture,
     "by suffix: .exr scene-linear with AOVs and metadata, .hdr scene-linear, .png .jpg .webp .tif as displayed; "
     "'-' is a PNG on stdout; repeatable; {name} {camera} {frame:4} {variant} and #### are filled in",
     NULL, "{name}.png", "a file name", &option_texts, FIELD(outputs), .also = JOB_COLOR,
     .except = JOB_BENCH | JOB_STUDY},
    {"size", 0, "WxH", picture, "pixels", NULL, "1024x1024, or 1024 and the aspect of the scene's camera",
     "a size WxH of 1 to 65536 pixels a side", &option_size, FIELD(size), .also = JOB_INSPECT},
    {"crop", 0, "X0,Y0,X1,Y1", picture, "renders that part alone; pixels, right and bottom exclusive", NULL, NULL,
     "a part X0,Y0,X1,Y1 of the picture with X0 < X1 and Y0 < Y1", &option_crop, FIELD(crop), .except = JOB_STUDY},
    {"aov", 0, "LIST", picture,
     "layers of .exr files: " AOV_NAMES ". Of lights and lobes '*' means all; what is left out is one more layer, so "
     "that each of the three divisions sums to the picture exactly",
     NULL, NULL, "a list such as albedo,lobe:*,lightgroup:key of " AOV_NAMES, &option_layers, FIELD(layers),
     .also = JOB_INSPECT, .except = JOB_STUDY},

    {"spp", 0, "N", quality, "samples per pixel; the same bits for any number of threads", NULL,
     "1024 with --noise 3%; bench: 16", "a whole number from 1 to 16777216", &option_count, .low = 1, .high = 16777216, FIELD(spp)},
    {"noise", 0, "P%", quality,
     "ends when the root of the estimated relative mean square error, of the pixels that show a surface, is below P; "
     "0: off. Giving any of these rules replaces the default; the first that is reached ends the render",
     NULL, "3% with --spp 1024", "a percentage from 0 to 100, such as 1.5%", &option_percent, FIELD(noise_percent),
     .except = JOB_BENCH},
    {"budget", 0, "DURATION", quality, "ends the run after this time, import and output included: 90, 90s, 500ms, 1.5m, 1h30m", NULL, NULL,
     "a time above 0 such as 90s or 1h30m", &option_duration, FIELD(budget_seconds), .except = JOB_BENCH},

    {"adaptive", 0, "auto|on|off", quality,
     "on: samples go to where they lower the error most, and --spp is their mean over the pixels; auto: where --noise or "
     "--budget is a rule. The picture then depends on --crop",
     "auto", NULL, "auto, on or off", &option_choices, adaptivities, FIELD(adaptive)},

    {"seed", 0, "N", estimator, "another seed gives another noise", "0", NULL, "a whole number from 0 to 2^64 - 1",
     &option_integer, FIELD(seed)},
    {"max-depth", 0, "N", estimator, "scattering events of a path; the energy that this cuts is reported", "64", NULL,
     "a whole number from 0 to 65535", &option_count, .high = 65535, FIELD(max_depth)},
    {"filter", 0, "KIND[:WIDTH]", estimator, "box, gaussian or blackman-harris, with its diameter in pixels",
     "blackman-harris:1.5", NULL, "a filter such as box:1, gaussian:2 or blackman-harris:1.5 of at most 16 pixels",
     &option_filter, FIELD(filter)},
    {"estimator", 0, "NAME", estimator,
     "bsdf, nee, or mis: both combined; naive and doubled are wrong on purpose, for 'kiln study'", "mis", NULL,
     "an estimator", &option_choices, estimators, FIELD(estimator)},
    {"roulette", 0, "POLICY", estimator, "Russian roulette: off, fixed:P, throughput[:MIN] or auto", "auto", NULL,
     "off, auto, fixed:P with 0 < P <= 1, or throughput[:MIN] with a number of guaranteed bounces", &option_roulette,
     FIELD(roulette)},
    {"sampler", 0, "NAME", estimator, "sobol (Owen-scrambled) or independent", "sobol", NULL, "a sampler",
     &option_choices, samplers, FIELD(sampler)},
    {"light-sampling", 0, "NAME", estimator, "how a light is chosen: tree, power or uniform", "tree", NULL,
     "a way of choosing lights", &option_choices, light_samplings, FIELD(light_sampling)},
    {"texture-filter", 0, "NAME", estimator,
     "textures seen small: bilinear, always from the picture, or mip, from pyramids by the footprint of the path",
     "bilinear", NULL, "a texture filter", &option_choices, texture_filters, FIELD(texture_filter)},

    {"camera", 0, "NAME|INDEX|auto", camera, "a camera of the file, counted from 0; auto frames the scene", NULL,
     "the first of the file, else auto", "the name of a camera", &option_text, FIELD(camera), .also = JOB_INSPECT},
    {"orbit", 0, "AZ,EL", camera, "auto's direction: degrees around the scene from its front, and upwards", "30,15",
     NULL, "two angles AZ,EL in degrees, EL from -90 to 90", &option_orbit, FIELD(orbit), .also = JOB_INSPECT},
    {"fov", 0, "DEG", camera, "vertical angle of view", NULL, "the camera's; 30 for auto",
     "an angle from 0.1 to 179 degrees", &option_number, .low = 0.1, .high = 179, FIELD(fov_deg), .also = JOB_INSPECT},
    {"frame-fit", 0, "F", camera, "share of the picture that auto lets the scene fill", "0.85", NULL,
     "a number from 0.01 to 100", &option_number, .low = 0.01, .high = 100, FIELD(frame_fit), .also = JOB_INSPECT},
    {"aperture", 0, "F-STOP", camera, "thin lens, for a sensor of 36 x 24 mm and a metre per unit; 0: pinhole", NULL,
     "the camera's", "a number from 0 to 1e9", &option_number, .high = 1e9, FIELD(aperture), .also = JOB_INSPECT},
    {"focus", 0, "DISTANCE|auto", camera, "metres along the axis; auto: what the middle of the picture sees", NULL,
     "the camera's, else auto", "a distance in metres above 0, or auto", &option_focus, FIELD(focus),
     .also = JOB_INSPECT},
    {"blades", 0, "N", camera, "sides of the aperture; 0: round", NULL, "the camera's",
     "a whole number from 0 to 64 (1 and 2 enclose nothing)", &option_count, .high = 64, FIELD(blades),
     .also = JOB_INSPECT},

    {"env", 0, "FILE|studio|none", light,
     "a latitude-longitude picture that lights the scene; studio is built in", NULL,
     "the file's lights, else studio", "the name of a file", &option_text, FIELD(env), .also = JOB_INSPECT},
    {"env-rotate", 0, "DEG", light, "turns the surroundings counter-clockwise seen from above", "0", NULL,
     "a number of degrees", &option_number, .low = -1e6, .high = 1e6, FIELD(env_rotate_deg), .also = JOB_INSPECT},
    {"env-intensity", 0, "X", light, "multiplies the surroundings", "1", NULL, "a number from 0 to 1e12",
     &option_number, .high = 1e12, FIELD(env_intensity), .also = JOB_INSPECT},
    {"background", 0, "env|transparent|#RRGGBB", light,
     "what the camera sees where nothing is; a colour is what the display shows", "env", NULL,
     "env, transparent or a colour #RRGGBB", &option_background, FIELD(background), .except = JOB_STUDY},

    {"subdivide", 0, "auto|off|N", surface,
     "auto refines what is evidently a smooth surface, N refines every mesh N times", "auto", NULL,
     "auto, off or a level from 1 to 6", &option_subdivide, FIELD(subdivide), .also = JOB_INSPECT},
    {"scheme", 0, "NAME", surface, "auto, catmull-clark, loop or bilinear", "auto", NULL, "a scheme", &option_choices,
     schemes, FIELD(scheme), .also = JOB_INSPECT},
    {"crease-angle", 0, "DEG", surface, "edges that bend more stay sharp when refined; 0: none", "0", NULL,
     "an angle from 0 to 180 degrees", &option_number, .high = 180, FIELD(crease_angle_deg), .also = JOB_INSPECT},

    {"exposure", 0, "EV", color, "stops; doubles the light with each", NULL,
     "0; chosen where the file has punctual lights", "a number of stops from -64 to 64", &option_number, .low = -64,
     .high = 64, FIELD(exposure), .also = JOB_COLOR, .except = JOB_BENCH},
    {"display", 0, "NAME", color, "'kiln info' lists displays and views", NULL, "the config's, sRGB",
     "the name of a display", &option_text, FIELD(display), .also = JOB_INFO | JOB_COLOR, .except = JOB_BENCH},
    {"view", 0, "NAME", color, "how scene-linear becomes a picture", NULL, "the config's, Khronos PBR Neutral",
     "the name of a view", &option_text, FIELD(view), .also = JOB_INFO | JOB_COLOR, .except = JOB_BENCH},
    {"look", 0, "NAME", color, "OpenColorIO looks in place of the view's own", NULL, "the view's", "the name of a look",
     &option_text, FIELD(look), .also = JOB_INFO | JOB_COLOR, .except = JOB_BENCH},
    {"ocio", 0, "FILE", color, "OpenColorIO config", NULL, "$OCIO, else embedded", "the name of a file", &option_text,
     FIELD(ocio), .also = JOB_INFO | JOB_COLOR},
    {"working-space", 0, "NAME", color, "scene-linear space that light is computed in", NULL, "lin_rec709",
     "the name of a colour space", &option_text, FIELD(working_space), .also = JOB_INFO | JOB_COLOR},

    {"effects", 0, "auto|all|LIST", machine,
     "what is simulated: auto, what the scene calls for; all, every term of the kernels, with the same bits; '-name' drops "
     "an effect and tells by how much the picture changes, '+name' runs one for nothing; 'kiln inspect' lists them",
     "auto", NULL, "auto, all, or a list such as -dispersion,+clearcoat", &option_effects, FIELD(effects),
     .also = JOB_INSPECT, .explain = option_explain_effects},
    {"threads", 0, "N", machine, "threads to work with", NULL, "$KILN_THREADS, else all cores",
     "a whole number from 1 to 4096", &option_count, .low = 1, .high = 4096, FIELD(threads),
     .also = JOB_INSPECT | JOB_INFO | JOB_COLOR},
    {"allow-outside", 0, NULL, machine,
     "the asset may refer to files outside its folder: ../textures, absolute paths, links; for assets that you trust",
     NULL, NULL, "true or false", &option_toggle, FIELD(allow_outside), .also = JOB_INSPECT},
    {"embree-config", 0, "STRING", machine, "passed to Embree's device, such as isa=avx2", NULL, NULL,
     "a list of Embree's settings such as isa=avx2,hugepages=1", &option_embree, FIELD(embree_config)},
    {"stats", 0, "FILE.json", machine, "writes everything that the run knows about itself", NULL, NULL, "a file name",
     &option_text, FIELD(stats), .except = JOB_BENCH | JOB_STUDY},
    {"strict", 0, NULL, machine, "an import warning or a discarded sample is a failure", NULL, NULL, "true or false",
     &option_toggle, FIELD(strict), .also = JOB_INSPECT, .except = JOB_BENCH | JOB_STUDY},

    {"embree", 0, NULL, measure, "replays the rays of the render through Embree and nothing else", NULL, NULL,
     "true or false", &option_toggle, FIELD(embree), .also = JOB_BENCH, .except = JOB_RENDER | JOB_STUDY},
    {"growth", 0, "LIST", measure,
     "how time and memory grow with pixels, triangles, instances, lights, depth, threads, or all; 'triangles:1e6' ends there",
     NULL, NULL, "a list", &option_text, FIELD(growth), .also = JOB_BENCH, .except = JOB_RENDER | JOB_STUDY},

    {"metric", 0, "NAME", compare,
     "relmse, mse or mae of the files' numbers, or flip: what is seen; of scene-linear files over all exposures",
     NULL, "all of them; of --threshold and -o relmse", "a metric", &option_choices, metrics, FIELD(metric),
     .also = JOB_COLOR, .except = JOB_RENDER | JOB_BENCH | JOB_STUDY},
    {"threshold", 0, "X", compare, "exit code 1 when the error is above X", NULL, NULL, "a number from 0 to 1e30",
     &option_number, .high = 1e30, FIELD(threshold), .also = JOB_COLOR, .except = JOB_RENDER | JOB_BENCH | JOB_STUDY},

    {"output", 'o', "DIR", study,
     "folder for report.html, rows.csv, study.json and pictures; a study that was begun there goes on", NULL, NULL,
     "the name of a folder", &option_texts, FIELD(outputs), .also = JOB_STUDY, .except = JOB_RENDER | JOB_BENCH},
    {"preset", 0, "NAME", study,
     "default, every setting that matters here; roulette, estimators, each with a scene of its own where none is "
     "given; effects, the price of each", "default", NULL, "a preset", &option_text, FIELD(preset), .also = JOB_STUDY,
     .except = JOB_RENDER | JOB_BENCH},
    {"reference", 0, "FILE", study, "scene-linear picture (.exr, .hdr) to measure errors against", NULL,
     "made by another estimator and other seeds", "the name of a file", &option_text, FIELD(reference),
     .also = JOB_STUDY, .except = JOB_RENDER | JOB_BENCH},
};

const option_table job_option_table = {rows, sizeof rows / sizeof *rows};
_Static_assert(sizeof rows / sizeof *rows <= 64, "one bit of job_options.given for each row");
