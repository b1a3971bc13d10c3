#include "message.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Cut a text, not inside a character: hosts decode UTF-8. */
static void cut(char *text, size_t length) {
    while (length > 0 && ((unsigned char)text[length] & 0xC0) == 0x80)
        length--;
    text[length] = '\0';
}

double message_number(double value) {
    return value == value ? value : NAN; /* mingw's isnan is a function of its math library */
}

void message_write_list(Message *message, const char *format, va_list arguments) {
    char text[sizeof message->text + 1] = "";
    vsnprintf(text, sizeof text, format, arguments);
    if (strlen(text) >= sizeof message->text)
        cut(text, sizeof message->text - 1);
    memcpy(message->text, text, sizeof message->text);
}

void message_write(Message *message, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    message_write_list(message, format, arguments);
    va_end(arguments);
}

void message_end(Message *message, const char *tail) {
    size_t size = strlen(tail) + 1, room = sizeof message->text - size;
    if (strlen(message->text) > room)
        cut(message->text, room);
    memcpy(message->text + strlen(message->text), tail, size);
}
