#include <stdio.h>

#include "options.h"

/* In parts, since compilers need not take longer strings. */
static const char *const part[] = {
    "tribo-damper: steady response of a structure with friction contacts to a harmonic load.\n"
    "\n"
    "Reads mass and stiffness, keeps the lowest modes, and finds the motion that repeats itself with every period of the load,\n"
    "to 1e-10, for Coulomb friction itself: contacts that slide, stick for a part of the period, or for ever.\n"
    "  one frequency (--drive HZ):       response over the limits of the contacts, the limit at which friction dissipates most,\n"
    "                                    and the motion there\n"
    "  a band (--drive FROM:TO:N):       response over frequency for each limit, and the best limit: the one with the least of\n"
    "                                    the largest amplitudes\n"
    "Points are added where curves bend. A motion that is not found leaves a gap, and a message in its place.\n"
    "\n"
    "The structure:\n"
    "  --mass FILE          Matrix Market, symmetric (lower triangle) or general\n"
    "  --stiffness FILE     the same\n"
    "  --dofs FILE          for each row of the matrices: row node direction x y z; direction 1, 2, 3 is x, y, z, and x y z are\n"
    "                       the node's place, lengths\n"
    "  --load X,Y,Z,DIR     at which node and along which axis, x, y or z, the harmonic load acts; amplitudes are those there\n"
    "  --contact CONTACT    X,Y,Z,DIR: a contact to ground at the node with these coordinates, sliding along DIR; may be given\n"
    "                       up to 32 times. Words may follow, parted by colons or blanks:\n"
    "                         to=X,Y,Z      not to ground but to this node\n"
    "                         limit=FORCE   its limit; without, it varies with --limits\n"
    "                         mu=NUMBER     its limit is this times what --limits says, which then are normal loads\n"
    "                         mu=NUMBER load=FORCE   its limit is the product\n"
    "  --contacts FILE      contacts, one a line, in the same words\n",
    "\n"
    "What may be left out:\n"
    "  --drive HZ           frequency of the load, or a band FROM:TO:N with N frequencies to begin with; 0 (the default): the\n"
    "                       first natural frequency\n"
    "  --limits FROM:TO:N   limits of the contacts, forces, N of them in equal ratios; 0.001 and 10 times the load's, 33, or 9\n"
    "                       for a band\n"
    "  --force AMPLITUDE    of the load, a force; 1\n"
    "  --modes COUNT        lowest modes to keep; 12, or all where there are fewer\n"
    "  --damping RATIO      of every mode to critical damping, above 0 and below 1; 0.002\n"
    "  --frequencies FILE   natural frequencies in Hz from elsewhere, to be shown beside those found; \"none\"\n"
    "  --method NAME        exact, or march: time steps by rk4 until the motion repeats itself, slow\n"
    "  --check N            finds N points by marching as well, and shows the differences; 0\n"
    "  --law NAME           friction law for marching; quinn\n"
    "  --step RADIANS       time step for marching times the highest natural frequency kept, at most 1; 0.25 (and at least 400\n"
    "                       steps a period)\n"
    "  --threads COUNT      one a core. Results do not depend on it\n"
    "  --out FOLDER         where the tables go, which must exist; \".\"\n"
    "  --name WORD          how the names of the tables begin; \"damper\"\n"
    "  --read FILE          options from a file, one a line, without the hyphens; names of files in it are relative to its\n"
    "                       folder. Lines that begin with # say nothing\n",
    "\n"
    "Any consistent units will do: N, m, kg, s; or N, mm, tonne, s. Frequencies are in Hz if time is in s, else in cycles a\n"
    "unit of time; powers in force times length over time (N mm/s = mW).\n"
    "\n"
    "Tables (comma-separated, in the folder of --out, damper being --name):\n"
    "  damper-frequencies.csv   mode, its natural frequency, that of --frequencies, relative difference\n"
    "  damper-curve.csv         one frequency: the response over the limit\n"
    "  damper-history.csv       one frequency: three periods at the limit of most power; cycle, time, displacement where the\n"
    "                           load acts, and of each contact velocity, force, and slip (0 sticks, 1 and -1 slides, 2 open)\n"
    "  damper-sticking.csv      the same at three times that limit\n"
    "  damper-family.csv        a band: the response over frequency, a blank line between curves\n"
    "  damper-best.csv          a band: the curve of the best limit\n"
    "  damper-linear.csv        a band: frequency, amplitude without friction, amplitude with all contacts stuck for ever\n"
    "  damper-check.csv         what --check found by marching\n"
    "  values-damper.txt        all single results, with all digits\n"
    "Responses have the columns: limit (1 if no contact follows); frequency; amplitude (half of the way from the\n"
    "smallest to the largest displacement); mean powers over a period, lost to friction, lost to damping, put in by the load;\n"
    "periods that were integrated to find it; message, which is empty if the motion was found, else the numbers are; and for\n"
    "each contact, in the order given, the power that it takes and the share of the period for which it sticks.\n"
    "\n"
    "Ends with status 0; with 1 and a message if something is wrong; with 130 after Ctrl-C, tables then holding what was found\n"
    "until then.\n"};

void print_help(void)
{
    for (size_t k = 0; k < sizeof part / sizeof *part; k++) {
        fputs(part[k], stdout);
    }
}
