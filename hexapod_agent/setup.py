"""Package hexapod_agent, as colcon and ament install it."""

from setuptools import find_packages, setup

NAME = 'hexapod_agent'

setup(
    name=NAME,
    version='0.1.0',
    description='DDPG agent on a chosen set of sensors, its environment and its training.',
    license='Apache-2.0',
    maintainer='Hexapod team',
    maintainer_email='team@hexapod.invalid',
    packages=find_packages(exclude=['test']),
    package_data={'hexapod_agent': ['*.yaml']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
    ],
    install_requires=['setuptools'],
    extras_require={'test': ['pytest']},
    zip_safe=False,
    entry_points={
        'console_scripts': [
            'agent_node = hexapod_agent.nodes.executables:agent_node',
            'play_node = hexapod_agent.nodes.executables:play_node',
            'train = hexapod_agent.train:main',
            'evaluate = hexapod_agent.evaluate:main',
            'export = hexapod_agent.export:main',
            'film = hexapod_agent.film:main',
        ],
    },
)
