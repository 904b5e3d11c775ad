/* Sine and cosine at once. */
#ifndef TRIBO_TURN_H
#define TRIBO_TURN_H

/* A function of its own, in which compilers see that it is the same angle: among branches they may not. */
void tribo_turn(double angle, double *cosine, double *sine);

#endif
