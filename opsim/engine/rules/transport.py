"""Which vehicle fetches a job, where a loaded one goes first, and how often somebody walks who cannot carry all."""


def soonest_there(drive_s, vehicle_number):
    """The free vehicle that is soonest at the job that has called longest."""
    return (drive_s, vehicle_number)


def nearest_stop(drive_s, place_rank):
    """Of the places where something on a vehicle goes, the nearest."""
    return (drive_s, place_rank)


def walks_to_carry(lot, mass_kg, most_load_kg):
    """How often somebody walks, there and back, to bring a lot whose units have a mass; a unit at least each time."""
    units_at_once = max(1, (most_load_kg + 1e-9) // mass_kg)
    trips = -(-lot // units_at_once)
    return 2 * trips - 1
