/* The least a display unit does, in C: newest panorama only, its age, NO IMAGE when none comes.
   lcm-gen -c bot_core_image_t.lcm bot_core_image_metadata_t.lcm
   cc subscriber.c bot_core_image_t.c bot_core_image_metadata_t.c -llcm -o subscriber
   ./subscriber 'udpm://239.255.76.67:7667?ttl=1&recv_buf_size=16777216' [PICTURES] */
#include <stdio.h>
#include <stdlib.h>
#include <sys/time.h>

#include "bot_core_image_t.h"

static long pictures = 0;

static void on_image(const lcm_recv_buf_t* buffer, const char* channel, const bot_core_image_t* image, void* user) {
    struct timeval now;
    (void)buffer, (void)channel, (void)user;
    gettimeofday(&now, NULL);
    /* Capture time against this clock: keep both set by NTP or PTP. */
    const double age_ms = (double)(now.tv_sec * 1000000LL + now.tv_usec - image->utime) / 1000;
    if (age_ms > 500) {
        printf("NO IMAGE: the picture is %.0f ms old\n", age_ms);
        return;
    }
    for (int i = 0; i < image->nmetadata; ++i) {
        const bot_core_image_metadata_t* property = &image->metadata[i];
        printf("%s %.*s  ", property->key, (int)property->n, (const char*)property->value);
    }
    printf("%dx%d age %.1f ms\n", image->width, image->height, age_ms);
    FILE* file = fopen("newest.jpg", "wb");
    if (file != NULL) {
        fwrite(image->data, 1, (size_t)image->size, file);
        fclose(file);
    }
    ++pictures;
}

int main(int argc, char** argv) {
    const long wanted = argc > 2 ? atol(argv[2]) : 0;
    lcm_t* lcm = lcm_create(argc > 1 ? argv[1] : "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=16777216");
    if (lcm == NULL) return 1;
    bot_core_image_t_subscription_t* images = bot_core_image_t_subscribe(lcm, "PANORAMA", on_image, NULL);
    bot_core_image_t_subscription_set_queue_capacity(images, 1); /* or pictures queue up and grow old */
    while (wanted == 0 || pictures < wanted) {
        const int handled = lcm_handle_timeout(lcm, 500);
        if (handled < 0) return 1;
        if (handled == 0) printf("NO IMAGE: none came\n");
        fflush(stdout);
    }
    lcm_destroy(lcm);
    return 0;
}
