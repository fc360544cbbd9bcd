#!/usr/bin/env python3
"""The link of executed images, as real clients decode it: pynmea2 its sentences, pymavlink its messages.

usage: clients.py EMULATED_BOARD IMAGE_FOLDER [CARRIER...]

EMULATED_BOARD is the built program (target/release/emulated-board), IMAGE_FOLDER has the images as `meridian emulate --board
all` leaves them (target/thumbv7em-none-eabihf/firmware): board-stage.elf and so on. Needs pynmea2 (1.19.0, MIT) and pymavlink
(2.4.50, LGPL-3.0). Each image is executed from power-on to its result and beyond, with a client at its link, which

- decodes every byte: it belongs to a sentence with the right checksum, which pynmea2 writes again as it came, or to a frame
  of MAVLink 2 of the dialect `common` with the right checksum, whose number follows that of the frame before;
- reads every setting, and gives it another value and its own again, by lines, and as a parameter while samples are measured;
- orders messages and intervals by commands, and that the settings are kept;
- holds what is valid to the states that are stated, and azimuth and attitude to the truth.

The report of the execution must then tell of no reset, loss or fault. A spinning body flies twice, since its flight is short:
it is asked by lines, then by messages. Exits with 1 where anything does not hold.
"""
import json
import math
import socket
import subprocess
import sys
import threading
from collections import Counter, deque, namedtuple
from decimal import Decimal

import pynmea2
from pymavlink.dialects.v20 import common as mavlink

CARRIERS = ['stage', 'two-frame', 'turntable', 'vehicle', 'spin']
AFTERWARDS = '12'       # How long an execution goes on after its azimuth, s of the board.
PATIENCE = 600          # How long it may say nothing, and take to end, s of the computer that executes it.
UNANSWERED = 200        # Bytes of questions that wait for their answers, at most: the port keeps 256 for its reader.
SIGMAS = 4              # How many sigma an angle may lie beside the truth.
INSTRUMENT, CLIENT = (1, mavlink.MAV_COMP_ID_IMU), (255, mavlink.MAV_COMP_ID_MISSIONPLANNER)
ESTIMATE, REAL = mavlink.MAVLINK_MSG_ID_VISION_POSITION_ESTIMATE, mavlink.MAV_PARAM_TYPE_REAL32
AZIMUTH = mavlink.MAV_SYS_STATUS_AHRS
SENSORS = mavlink.MAV_SYS_STATUS_SENSOR_3D_GYRO | mavlink.MAV_SYS_STATUS_SENSOR_3D_ACCEL | AZIMUTH
# States by the number that a heartbeat has for them, with its own state of the system.
STATES = [('waiting', mavlink.MAV_STATE_STANDBY), ('aligning', mavlink.MAV_STATE_CALIBRATING), ('ready', mavlink.MAV_STATE_ACTIVE),
          ('degraded', mavlink.MAV_STATE_CRITICAL), ('failed', mavlink.MAV_STATE_EMERGENCY)]
# Whether what is said has a valid azimuth.
IS_VALID = {'HEHDT': lambda it: it.heading is not None, 'HETHS': lambda it: it.mode == 'A', 'VISION_POSITION_ESTIMATE': lambda it: True,
            'PHINF': lambda it: int(it.data[1], 16) & 1 == 0, 'SYS_STATUS': lambda it: it.onboard_control_sensors_health & AZIMUTH != 0}
# Words of settings that are a choice, whose index is the parameter's value. All others of words are yes or no.
WORDS = {'output': ['nmea', 'mavlink'], 'half': ['none', 'east', 'west'], 'sensor': ['gyro', 'molecular']}
# Another rate for each, of which the estimate has 0 and 10 Hz alone; and values for what is none.
OTHER_RATES = {'0': '10', '1': '2', '2': '1', '5': '10', '10': '0'}
OTHERS_THAN_NONE = {'survey': '600', 'allowed': '600', 'speed_2': '0.1'}

# Words for what is asked, the bytes that ask it, and whether what comes is the answer.
Question = namedtuple('Question', 'words sent is_answer')


class THS(pynmea2.TalkerSentence):
    """Heading and mode, which pynmea2 1.19.0 does not have."""
    fields = (('Heading', 'heading', Decimal), ('Mode', 'mode'))


class Wrong(Exception):
    """What does not hold, in words."""


def require(holds, words):
    if not holds:
        raise Wrong(words)


class Link:
    """A client of an instrument's link, which decodes all that comes."""

    def __init__(self, port):
        self.connection = socket.create_connection(('127.0.0.1', port), PATIENCE)
        self.stream = self.connection.makefile('rb')
        self.codec = mavlink.MAVLink(None, *CLIENT)
        self.said = []          # Kind and content of each sentence and message, in their order.
        self.number = None      # That of the next message.

    def listen(self):
        """Kind and content of the next sentence or message; none at the end of the execution, also amid one of them."""
        while byte := self.stream.read(1):
            if self.codec.buf_len() == 0 and byte != b'\xfd':
                line = byte + self.stream.readline()
                if line.startswith(b'$') and len(line) < 82 and b'\n' not in line:
                    break
                self.said.append(sentence(line.decode('ascii')))
                return self.said[-1]
            if message := self.codec.parse_char(byte):
                self.said.append((message.get_type(), self.checked(message)))
                return self.said[-1]
        return None

    def checked(self, message):
        """A message of the dialect, from the instrument, the next by its number, and no refusal."""
        number, component = message.get_seq(), message.get_srcComponent()
        is_known = not isinstance(message, mavlink.MAVLink_unknown) and component == INSTRUMENT[1]
        is_refusal = message.get_type() == 'STATUSTEXT' and message.severity <= mavlink.MAV_SEVERITY_WARNING
        require(is_known and not is_refusal, f'{message} of the component {component}')
        require(self.number in (None, number), f'{message} has the number {number} instead of {self.number}')
        self.number = (number + 1) % 256
        return message

    def question(self, message, is_answer):
        """A message as a question."""
        sent = message.pack(self.codec)
        self.codec.seq = (self.codec.seq + 1) % 256
        return Question(f'{message}', sent, is_answer)

    def until(self, kind, is_it=lambda it: True):
        """Listens until something of a kind comes; its content."""
        while heard := self.listen():
            if heard[0] == kind and is_it(heard[1]):
                return heard[1]
        raise Wrong(f'the execution ended before the {kind} that was waited for')

    def ask(self, questions):
        """Asks questions, several at a time; their answers, and all that came meanwhile."""
        questions, waiting, answers, begin = deque(questions), deque(), [], len(self.said)
        while questions or waiting:
            try:
                while questions and sum(len(asked.sent) for asked in (*waiting, questions[0])) <= UNANSWERED:
                    waiting.append(questions.popleft())
                    self.connection.sendall(waiting[-1].sent)
                heard = self.listen()
            except ConnectionError:
                heard = None
            require(heard, f'no answer to {waiting[0].words} until the execution ended, and {len(questions)} more to ask')
            if waiting[0].is_answer(*heard):
                answers.append(heard[1])
                waiting.popleft()
        return answers, self.said[begin:]


def sentence(line):
    """Kind and content of a sentence."""
    decoded = pynmea2.parse(line, check=True)
    require(decoded.render(newline=True) == line and len(line) <= 82, f'{line!r} is {decoded!r}')
    return line[1:].split(',')[0], decoded


def by_lines(link, commands):
    """Gives commands as sentences; the fields of their answers, and all that came meanwhile."""
    def question(words):
        sent = pynmea2.ProprietarySentence('MRD', ['C', *words]).render(newline=True)
        # The list of all settings ends with its own answer.
        is_answer = lambda kind, it: kind == 'PMRDR' and (words != ('get',) or len(it.data) == 3)
        return Question(' '.join(words), sent.encode(), is_answer)
    answers, heard = link.ask([question(words) for words in commands])
    for words, answer in zip(commands, answers):
        require(answer.data[1:3] == [words[0], *(words[1:2] or ['ok'])], f'{" ".join(words)}: {answer}')
    return [answer.data[1:] for answer in answers], heard


def by_messages(link, commands):
    """Gives commands as messages to this component alone, which are accepted; the messages that came meanwhile, by kind."""
    def question(number, *parameters):
        message = mavlink.MAVLink_command_long_message(*INSTRUMENT, number, 0, *parameters, *[0] * (7 - len(parameters)))
        return link.question(message, lambda kind, it: kind == 'COMMAND_ACK')
    answers, heard = link.ask([question(*command) for command in commands])
    for (number, *_), it in zip(commands, answers):
        accepted = (number, mavlink.MAV_RESULT_ACCEPTED, *CLIENT)
        require((it.command, it.result, it.target_system, it.target_component) == accepted, f'{it} to the command {number}')
    return {kind: [it for other, it in heard if other == kind] for kind, _ in heard}


def words_of(name, text):
    """The words of a setting that is a choice."""
    return WORDS.get(name) or (['no', 'yes'] if text in ('no', 'yes') else [])


def value(name, text):
    """The value of a setting as its parameter has it."""
    words = words_of(name, text)
    return float(words.index(text)) if words else math.nan if text == 'none' else float(text)


def another(name, text):
    """Another value for a setting: the next word or rate, or a number greater by a hundredth, and by one in its last digit."""
    if words := words_of(name, text):
        return words[(words.index(text) + 1) % len(words)]
    if text == 'none' or name.endswith('_rate'):
        return OTHERS_THAN_NONE[name] if text == 'none' else OTHER_RATES[text]
    digit = Decimal(1).scaleb(Decimal(text).as_tuple().exponent)
    return format(max(Decimal(text) + digit, (Decimal(text) * Decimal('1.01')).quantize(digit)), 'f')


def same(number, other):
    """Whether two numbers are the same in single precision."""
    return math.isclose(number, other, rel_tol=1e-6) or (math.isnan(number) and math.isnan(other))


def asked_by_lines(link, settings):
    """Reads and sets all settings by lines; their values by name, which were not known before."""
    _, heard = by_lines(link, [('get',)])
    listed = [it.data[2:] for kind, it in heard if kind == 'PMRDR' and len(it.data) == 4]
    names = [name for name, _ in listed]
    require(names[:3] == ['carrier', 'serial', 'firmware'] and len(set(names)) == len(names), f'listed: {names}')
    settings |= dict(listed[3:])
    steps = [step for name, text in settings.items() for step in [
        ('set', name, text), ('set', name, another(name, text)), ('get', name, another(name, text)), ('set', name, text)]]
    answers, _ = by_lines(link, [step if step[0] == 'set' else step[:2] for step in steps])
    for (word, name, text), (*_, said) in zip(steps, answers):
        require(same(value(name, said), value(name, text)), f'{word} {name} {text}: {said}')
    return settings


def measuring(link, settings):
    """Waits until the first dwell or turn is done; the settings as they are."""
    link.until('PMRDS', lambda it: it.data[7] not in ('', '0'))
    return settings


def settings_by_messages(link, settings):
    """Reads and sets all settings as parameters, which have the values that were read by lines."""
    # To all systems: the number of the system is one of the settings, and counts from a tenth of a second after it is set.
    to, names, expected, questions = (0, INSTRUMENT[1]), list(settings), list(settings.items()), []
    is_value = lambda kind, it: kind == 'PARAM_VALUE'
    is_last = lambda kind, it: is_value(kind, it) and it.param_index == len(names) - 1
    _, heard = link.ask([link.question(mavlink.MAVLink_param_request_list_message(*to), is_last)])
    for number, (name, text) in enumerate(settings.items()):
        other, letters = another(name, text), name.encode()
        for message, shown in [
                (mavlink.MAVLink_param_set_message(*to, letters, value(name, other), REAL), other),
                (mavlink.MAVLink_param_request_read_message(*to, letters, -1), other),
                (mavlink.MAVLink_param_set_message(*to, letters, value(name, text), REAL), text),
                (mavlink.MAVLink_param_request_read_message(*to, b'', number), text)]:
            questions.append(link.question(message, is_value))
            expected.append((name, shown))
    values = [it for kind, it in heard if is_value(kind, it)] + link.ask(questions)[0]
    require(len(values) == len(expected), f'{len(values)} parameters came instead of {len(expected)}')
    for it, (name, text) in zip(values, expected):
        is_it = (it.param_id, it.param_index, it.param_count, it.param_type) == (name, names.index(name), len(names), REAL)
        require(is_it and same(it.param_value, value(name, text)), f'{it} instead of {name} {text}')


def asked_by_messages(link, settings):
    """Reads and sets all settings by messages, orders a message and intervals, and that the settings are kept; the settings."""
    by_lines(link, [('set', 'output', 'mavlink')])
    settings_by_messages(link, {**settings, 'output': 'mavlink'})
    interval = (mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_MESSAGE_INTERVAL, ESTIMATE)
    heard = by_messages(link, [
        (mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_SYS_STATUS),
        (mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, ESTIMATE, 100_000), interval,
        (mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, ESTIMATE, -1), interval,
        (mavlink.MAV_CMD_PREFLIGHT_STORAGE, 1)])
    stated = [(it.message_id, it.interval_us) for it in heard['MESSAGE_INTERVAL']]
    require('SYS_STATUS' in heard and stated == [(ESTIMATE, 100_000), (ESTIMATE, -1)], f'what was ordered: {heard}')
    by_lines(link, [('set', 'output', 'nmea')])
    return settings


def attitudes(link):
    """Headings, degrees, of an attitude and of the estimate that an autopilot fuses."""
    by_messages(link, [(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, ESTIMATE, 100_000)])
    turned, estimate = link.until('ATTITUDE_QUATERNION'), link.until('VISION_POSITION_ESTIMATE')
    link.until('HEARTBEAT', lambda it: it.get_srcSystem() == INSTRUMENT[0])
    by_messages(link, [(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, ESTIMATE, -1)])
    w, x, y, z = turned.q1, turned.q2, turned.q3, turned.q4
    require(same(math.hypot(w, x, y, z), 1), f'{turned}')
    variances = {place: variance for place, variance in enumerate(estimate.covariance) if variance != 0}
    is_nowhere = (estimate.x, estimate.y, estimate.z, *list(variances.values())[:3]) == (0, 0, 0, 1e4, 1e4, 1e4)
    require(is_nowhere and list(variances) == [0, 6, 11, 15, 18, 20], f'{estimate}')
    return [math.degrees(math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))), math.degrees(estimate.yaw)]


def headings_after(link):
    """Waits for the result of an alignment; headings, the first of them its own, and their sigma, degrees."""
    found = link.until('HEHDT', lambda it: it.heading is not None).heading
    sigma = link.until('PMRDS', lambda it: it.data[1] == 'ready').data[2]
    by_lines(link, [('set', 'output', 'mavlink')])
    others = attitudes(link)
    by_lines(link, [('set', 'output', 'nmea')])
    return [float(found), *others, float(link.until('HETHS', lambda it: it.mode == 'A').heading)], float(sigma)


def check_states(said, has_azimuth):
    """Holds what is said to be valid to the states that were stated before and after it."""
    before, between = None, []
    for kind, it in said:
        if kind in IS_VALID:
            between.append((it, IS_VALID[kind](it)))
        if kind == 'HETHS':
            require((it.heading is None) == (it.mode == 'V'), f'{it}')
        if kind == 'SYS_STATUS':
            require((it.onboard_control_sensors_present, it.errors_count1) == (SENSORS, 0), f'{it}')
        if kind == 'HEARTBEAT':
            state, of_system = STATES[it.custom_mode & 0xFF]
            expected = (mavlink.MAV_TYPE_IMU, mavlink.MAV_AUTOPILOT_INVALID, of_system)
            require((it.type, it.autopilot, it.system_status) == expected, f'{it}')
        if kind in ('PMRDS', 'HEARTBEAT'):
            now = it.data[1] if kind == 'PMRDS' else state
            for words, valid in between:
                possible = {before == 'ready', now == 'ready'} if has_azimuth else {False}
                require(valid in possible, f'{words} between the states {before} and {now}')
            before, between = now, []


def show_errors(lines):
    """Shows what the program says beside the log, whose lines begin with a blank."""
    for line in lines:
        if not line.startswith(' '):
            sys.stderr.write(line)


def execute(program, folder, carrier, parts, settings):
    """Executes the image of a carrier with a client at its link; the settings, the result in words, and all that was said."""
    words = [program, f'{folder}/board-{carrier}.elf', '--carrier', carrier, '--link', 'tcp:0', '--afterwards', AFTERWARDS]
    process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        begun = process.stderr.readline()
        require(begun.startswith('waiting for a client at'), begun.strip())
        threading.Thread(target=show_errors, args=[process.stderr], daemon=True).start()
        link = Link(int(begun.rsplit(':', 1)[1]))
        link.listen()
        for part in parts:
            settings = part(link, settings)
        headings, sigma = headings_after(link) if carrier != 'spin' else ([], None)
        while link.listen():
            pass
        report = json.loads(process.stdout.read())
        require(process.wait(PATIENCE) == 0, f'the program ended with {process.returncode}')
    finally:
        process.kill()
    wrong = {key: report[key] for key in ('resets', 'violations', 'false_notices', 'faults') if report[key]}
    lost = [part['lost'] for part in report['service']]
    require(not wrong and not any(lost), f'{[part.__name__ for part in parts]}: {wrong}, conversions lost: {lost}')
    check_states(link.said, carrier != 'spin')
    if carrier == 'spin':
        roll = [it for kind, it in link.said if kind == 'PMRDL'][-1].data
        require(roll[3] == 'locked', f'the roll at the end: {roll}')
        return settings, f'roll locked, sigma {roll[2]} deg', link.said
    headings.append(report['azimuth_deg'][0])
    apart = [abs((heading - report['truth_deg'] + 180) % 360 - 180) / sigma for heading in headings]
    require(max(apart) <= SIGMAS, f'headings of {headings}, with a sigma of {sigma}, and a truth of {report["truth_deg"]}')
    return settings, f'azimuth {headings[0]:.3f} deg, sigma {sigma:.3f} deg, {apart[0]:.1f} sigma from the truth', link.said


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program, folder, *carriers = sys.argv[1:]
    for carrier in carriers or CARRIERS:
        # A vehicle counts neither dwells nor turns.
        sessions = {'spin': [[asked_by_lines], [asked_by_messages]], 'vehicle': [[asked_by_lines, asked_by_messages]]}.get(
            carrier, [[asked_by_lines, measuring, asked_by_messages]])
        settings, said = {}, []
        try:
            for parts in sessions:
                settings, result, heard = execute(program, folder, carrier, parts, settings)
                said += heard
        except (Wrong, OSError, ValueError, LookupError, mavlink.MAVError, subprocess.TimeoutExpired) as error:
            sys.exit(f'{carrier}: {type(error).__name__}: {error}')
        counts = ', '.join(f'{count} {kind}' for kind, count in sorted(Counter(kind for kind, _ in said).items()))
        print(f'{carrier}: {result}; {len(settings)} settings by lines and by messages; {counts}', flush=True)


main()
